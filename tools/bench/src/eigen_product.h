// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace palpate::bench {

/// u = X^T y by Eigen, float32: what a program without kernels of its own would do. Built for several
/// instruction sets, the widest that the processor has is taken. @param X  [n][rows], @param y  [n], @param u
/// [rows], overwritten
void eigenProduct(std::span<const float> X, std::span<const float> y, std::span<float> u);

/// Instruction set that eigenProduct() takes here: "avx512", "avx2" or "baseline".
[[nodiscard]] const char* eigenInstructions();

}  // namespace palpate::bench
