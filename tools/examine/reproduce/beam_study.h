// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/examine/reproduce/beam_options.h"
#include "tools/examine/reproduce/output.h"
#include "tools/program/json.h"

namespace palpate::reproduce {

/// Section 4.2, Figures 2 to 4. @throw std::runtime_error when a solver fails
[[nodiscard]] Json reproduceBeam(const BeamOptions& options, Output& out);

}  // namespace palpate::reproduce
