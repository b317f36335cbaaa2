// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set (CMakeLists.txt). Each time Eigen's namespace gets another name: the
// variants' inline functions differ in code, and under equal names the linker would keep one for all.
#define Eigen PALPATE_EIGEN_NAMESPACE
#include "tools/examine/bench/eigen_variants.h"

#include <Eigen/Core>

namespace palpate::bench {

void PALPATE_EIGEN_PRODUCT(const float* X, const float* y, float* u, long rows, long modes) {
  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic>;
  const Eigen::Map<const Matrix> map(X, rows, modes);
  Eigen::Map<Eigen::VectorXf>(u, rows).noalias() = map * Eigen::Map<const Eigen::VectorXf>(y, modes);
}

}  // namespace palpate::bench
