// SPDX-License-Identifier: Apache-2.0
#include "kernels.h"

#include "multiversion.h"

namespace palpate {

PALPATE_MULTIVERSION void addWeightedRows(const float* A, std::size_t stride, const float* weight,
                                          std::size_t rows, std::size_t length,
                                          float* y) noexcept PALPATE_NONBLOCKING {
  std::size_t r = 0;
  for (; r + 4 <= rows; r += 4) {  // four rows at a time: one pass over y for four over A
    const float* __restrict__ const a0 = A + r * stride;
    const float* __restrict__ const a1 = a0 + stride;
    const float* __restrict__ const a2 = a1 + stride;
    const float* __restrict__ const a3 = a2 + stride;
    const float w0 = weight[r], w1 = weight[r + 1], w2 = weight[r + 2], w3 = weight[r + 3];
    float* __restrict__ const out = y;
    for (std::size_t i = 0; i < length; ++i) out[i] += (w0 * a0[i] + w1 * a1[i]) + (w2 * a2[i] + w3 * a3[i]);
  }
  for (; r < rows; ++r) {
    const float* __restrict__ const a = A + r * stride;
    float* __restrict__ const out = y;
    for (std::size_t i = 0; i < length; ++i) out[i] += weight[r] * a[i];
  }
}

PALPATE_MULTIVERSION void dotRows(const float* A, std::size_t stride, const float* y, std::size_t rows,
                                  std::size_t length, float* out) noexcept PALPATE_NONBLOCKING {
  constexpr std::size_t kLanes = 16;
  for (std::size_t r = 0; r < rows; ++r) {
    const float* const a = A + r * stride;
    float lane[kLanes] = {};
    std::size_t i = 0;
    for (; i + kLanes <= length; i += kLanes)
      for (std::size_t k = 0; k < kLanes; ++k) lane[k] += a[i + k] * y[i + k];
    for (std::size_t k = 0; i < length; ++i, ++k) lane[k] += a[i] * y[i];
    out[r] = 0.0F;
    for (const float part : lane) out[r] += part;
  }
}

PALPATE_MULTIVERSION void addWeighted(double weight, const double* a, std::size_t length,
                                      double* y) noexcept PALPATE_NONBLOCKING {
  const double* __restrict__ const in = a;
  double* __restrict__ const out = y;
  for (std::size_t i = 0; i < length; ++i) out[i] += weight * in[i];
}

PALPATE_MULTIVERSION double dot(const double* a, const double* b,
                                std::size_t length) noexcept PALPATE_NONBLOCKING {
  constexpr std::size_t kLanes = 8;  // partial sums, so that the additions need not wait for each other
  double sum[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= length; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sum[lane] += a[i + lane] * b[i + lane];
  double total = 0.0;
  for (; i < length; ++i) total += a[i] * b[i];
  for (const double part : sum) total += part;
  return total;
}

}  // namespace palpate
