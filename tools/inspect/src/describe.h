// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "palpate/core/meta_model.h"

namespace palpate::inspect {

/// All that palpate-inspect says about a model: kind, sizes, material, bytes of each part, quantiles over the
/// accessible positions of what is trusted (m, N, or a load level), provenance. SI units.
[[nodiscard]] nlohmann::ordered_json describe(const MetaModel& model);

/// The same for a person to read, several lines.
[[nodiscard]] std::string table(const nlohmann::ordered_json& description);

}  // namespace palpate::inspect
