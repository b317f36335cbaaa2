// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/data/model_view.h"

namespace palpate::certify {

/// How far tools press, and who says so.
struct Travel {
  double length;     ///< m
  std::string from;  ///< for people: "asked for", "what it was solved for", "the default of this stiffness"
};

/// What tools may press by, m: one that is asked for, or a model's.
inline constexpr double kShortestTravel = 1e-9, kLongestTravel = 0.1;

/// @param asked  of the command line, m; else the travel of the model's provenance, else 7 mm where E < 50 kPa and 5 mm elsewhere
/// @throw CertifyError  the provenance has a travel that is not a number in that range
[[nodiscard]] Travel travelOf(const ModelAttributes& attributes, std::optional<double> asked);

}  // namespace palpate::certify
