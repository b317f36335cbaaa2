// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::bench {

/// u = X^T y. @param rows  of u, columns of X in memory, @param modes  of y
using EigenProduct = void(const float* X, const float* y, float* u, long rows, long modes);

EigenProduct eigenBaseline;
EigenProduct eigenAvx2;
EigenProduct eigenAvx512;

}  // namespace palpate::bench
