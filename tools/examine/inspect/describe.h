// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/model/meta_model.h"
#include "tools/program/json.h"

namespace palpate::inspect {

/// All that palpate-inspect says about a model: kind, sizes, material, bytes of each part, quantiles over the
/// accessible positions of what is trusted (m, N, or a load level), certificate, provenance. SI units.
[[nodiscard]] program::Json describe(const MetaModel& model);

/// The same for a person to read, several lines.
[[nodiscard]] std::string table(const program::Json& description);

}  // namespace palpate::inspect
