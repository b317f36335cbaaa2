// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/model/field_evaluation.h"
#include "core/model/meta_model.h"
#include "tools/modelfile/model_data.h"

namespace palpate::bench {

/// y of one tool, m, from the data in double precision. @param[in] model  the data as loaded, for surface,
/// functions, patches and their stiffness only. @throw std::invalid_argument  a node of the patch has no Green's function of its
/// own, which is so in a handheld model
[[nodiscard]] std::vector<double> referenceAmplitudes(const modelfile::ModelData& data,
                                                      const MetaModel& model, const FieldSource& source);

/// u = X^T y, m, in double precision. @param[in] y  [n]
[[nodiscard]] std::vector<double> referenceModes(const modelfile::ModelData& data, std::span<const float> y);

/// Far plus near field of one tool, m, in double precision: plain sums that share nothing with core's
/// kernels. @return [Ns][3]  @throw std::invalid_argument  as above
[[nodiscard]] std::vector<double> referenceField(const modelfile::ModelData& data, const MetaModel& model,
                                                 const FieldSource& source);

}  // namespace palpate::bench
