// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "palpate/core/meta_model.h"

namespace palpate::inspect {

/// All that palpate-inspect says about a model: sizes, material, bytes of each part, quantiles of the domain
/// radius over the accessible positions (m), provenance. SI units.
[[nodiscard]] nlohmann::ordered_json describe(const MetaModel& model);

/// The same for a person to read, several lines.
[[nodiscard]] std::string table(const nlohmann::ordered_json& description);

}  // namespace palpate::inspect
