// SPDX-License-Identifier: Apache-2.0
#include "kernels.h"

#include <algorithm>

#include "multiversion.h"

namespace palpate {

namespace {

/// Four numbers side by side, of gcc and clang; two pairs where the processor has no more.
using Lanes [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;

const Lanes& lanesAt(const double* p) noexcept {
  return *reinterpret_cast<const Lanes*>(p);
}

}  // namespace

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

PALPATE_MULTIVERSION void mixRows(const Rows& rows, const double* weight, std::size_t length,
                                  double* y) noexcept PALPATE_NONBLOCKING {
  double* __restrict__ const out = y;
  const auto begin = [&](std::size_t r) {
    return rows.A + rows.stride * static_cast<std::size_t>(rows.row[r]);
  };
  for (std::size_t i = 0; i < length; ++i) out[i] = 0.0;
  std::size_t r = 0;
  for (; r + 4 <= rows.count; r += 4) {  // as above
    const double* __restrict__ const a0 = begin(r);
    const double* __restrict__ const a1 = begin(r + 1);
    const double* __restrict__ const a2 = begin(r + 2);
    const double* __restrict__ const a3 = begin(r + 3);
    const double w0 = weight[r], w1 = weight[r + 1], w2 = weight[r + 2], w3 = weight[r + 3];
    for (std::size_t i = 0; i < length; ++i) out[i] += (w0 * a0[i] + w1 * a1[i]) + (w2 * a2[i] + w3 * a3[i]);
  }
  for (; r < rows.count; ++r) {
    const double* __restrict__ const a = begin(r);
    const double w = weight[r];
    for (std::size_t i = 0; i < length; ++i) out[i] += w * a[i];
  }
}

PALPATE_MULTIVERSION void dotRows(const Rows& rows, const double* y, std::size_t length,
                                  double* out) noexcept PALPATE_NONBLOCKING {
  const auto begin = [&](std::size_t r) {
    return rows.A + rows.stride * static_cast<std::size_t>(rows.row[r]);
  };
  for (std::size_t r = 0; r < rows.count; r += 4) {  // four at a time; the last ones may be the same row
    const std::size_t last = rows.count - 1;
    const double* const a[4] = {begin(r), begin(std::min(r + 1, last)), begin(std::min(r + 2, last)),
                                begin(std::min(r + 3, last))};
    Lanes even[4] = {}, odd[4] = {};  // partial sums, so that the additions need not wait for each other
    for (std::size_t i = 0; i < length; i += 8)
      for (std::size_t k = 0; k < 4; ++k) {
        even[k] += lanesAt(a[k] + i) * lanesAt(y + i);
        odd[k] += lanesAt(a[k] + i + 4) * lanesAt(y + i + 4);
      }
    for (std::size_t k = 0; k < 4 && r + k < rows.count; ++k) {
      const Lanes sum = even[k] + odd[k];
      out[r + k] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    }
  }
}

}  // namespace palpate
