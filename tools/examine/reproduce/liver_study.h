// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/examine/reproduce/liver_options.h"
#include "tools/examine/reproduce/output.h"
#include "tools/program/json.h"

namespace palpate::reproduce {

/// Section 4.3, Figures 5 to 7. @throw mesh::MeshError, std::runtime_error
[[nodiscard]] Json reproduceLiver(const LiverOptions& options, Output& out);

}  // namespace palpate::reproduce
