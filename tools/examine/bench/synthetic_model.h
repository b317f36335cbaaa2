// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/modelfile/model_data.h"

namespace palpate::bench {

/// Size of a synthetic model.
struct SyntheticSize {
  int nodes;      ///< Ns
  int modes;      ///< n
  int positions;  ///< M, the nodes nearest to the top; memory that no tick reads is left out
};

/// A synthetic organ as large as the default one (0.15 m, 25 mm of near field, order 3, forces to order 6),
/// float32 throughout. Modes are smooth waves, finer and weaker as their number rises: area mean of |X_k|^2
/// 1, y_k about 1.3 mm / (1 + (k / 2.5)^1.5), like those of the default organ (rms over random contacts: 1.3,
/// 0.086, 0.018, 0.008 mm at 0, 10, 40, 100). The contact's force is the gradient of a synthetic energy;
/// field and contact are independent of each other.
[[nodiscard]] modelfile::ModelData syntheticModel(const SyntheticSize& size);

}  // namespace palpate::bench
