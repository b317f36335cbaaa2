// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "palpate/core/types.h"

namespace palpate {

/// y[i] += sum over `rows` rows of weight[r] * A[r * stride + i], i < length. The loops that a tick spends
/// its time in: y stays in the first-level cache while A streams past once. Real-time: yes.
void addWeightedRows(const float* A, std::size_t stride, const float* weight, std::size_t rows,
                     std::size_t length, float* y) noexcept PALPATE_NONBLOCKING;

/// out[r] = sum over i < length of A[r * stride + i] * y[i], in 16 partial sums that run side by side.
/// Real-time: yes.
void dotRows(const float* A, std::size_t stride, const float* y, std::size_t rows, std::size_t length,
             float* out) noexcept PALPATE_NONBLOCKING;

/// y += weight * a. Real-time: yes.
void addWeighted(double weight, const double* a, std::size_t length, double* y) noexcept PALPATE_NONBLOCKING;

/// a . b. Real-time: yes.
[[nodiscard]] double dot(const double* a, const double* b, std::size_t length) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
