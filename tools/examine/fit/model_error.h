// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/data/model_view.h"
#include "tools/examine/fit/estimate.h"
#include "tools/examine/fit/press.h"

namespace palpate::fit {

/// What the model's certificate bounds of the force's error, with its floor, 5 % of the force at the certified travel:
/// 95 % of touches are within it. At a place of the other 5 % the model is off by more, and so is E.
/// @return nothing where the model is not certified, or has a certificate without such a bound  docs/design.md, Certificate
[[nodiscard]] std::optional<ModelError> certifiedError(const ModelAttributes& attributes, const Press& press);

/// What is taken for it where there is no certificate: 1 %, what palpate-solve asks of its fits, with the force at d_max.
[[nodiscard]] ModelError assumedError(const Press& press);

/// By what share the mesh is too stiff, in the mean, as the solver has found; nothing where it was not asked.
[[nodiscard]] std::optional<double> meshError(const ModelAttributes& attributes);

}  // namespace palpate::fit
