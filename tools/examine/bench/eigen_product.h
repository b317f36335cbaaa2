// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace palpate::bench {

/// u = X^T y by Eigen, float32: the choice of a program without kernels of its own. Built for several
/// instruction sets; it uses the widest that the processor has. @param X  [n][rows], @param y  [n], @param u
/// [rows], overwritten
void eigenProduct(std::span<const float> X, std::span<const float> y, std::span<float> u);

/// Instruction set that eigenProduct() uses here: "avx512", "avx2" or "baseline".
[[nodiscard]] const char* eigenInstructions();

}  // namespace palpate::bench
