// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace palpate {

// The loops that a tick spends its time in, through Highway: built for several instruction sets, of which the first
// call takes the best that the processor has. Results differ between them in rounding only.

/// Takes it before the loop. Threads: any; no other kernel may run meanwhile for the first time.
void chooseKernels() noexcept;

/// Sums that are taken at once: a row is read for all of them.
inline constexpr std::size_t kTogether = 4;

/// Floats of a node: kTogether vectors, of which the fourth numbers have no meaning, or one matrix and no more.
inline constexpr std::size_t kNodeFloats = 4 * kTogether;

/// u[node[i]][c] += factor * y[c][i]. @param y  [kTogether][count][3], and a number behind  @param u  [Ns][kNodeFloats].
/// Real-time: yes.
void addVectors(const float* y, const std::int32_t* node, std::size_t count, float factor,
                float* u) noexcept PALPATE_NONBLOCKING;

/// y += factor * from. @param from  as long as y. Real-time: yes.
void addScaled(const float* from, float factor, std::span<float> y) noexcept PALPATE_NONBLOCKING;

/// Rows that lie here and there: number r is at A + length * row[r], r < count.
template <class Numbers>
struct PlacedRows {
  Numbers A;
  std::size_t length;
  const std::int32_t* row;
  std::size_t count;
};
using PlacedFloats = PlacedRows<const float*>;

/// y[c] = sum_r weight[r][c] * row r. @param weight  [count][kTogether]  @param y  [kTogether][length]. Real-time: yes.
void mixRowsTogether(const PlacedFloats& rows, const float* weight, float* y) noexcept PALPATE_NONBLOCKING;

/// out[r] = sum over i < length of A[r * stride + i] * y[i]. Real-time: yes.
void dotRows(const float* A, std::size_t stride, const float* y, std::size_t rows, std::size_t length,
             float* out) noexcept PALPATE_NONBLOCKING;

/// No infinity and no NaN. Real-time: yes.
[[nodiscard]] bool allFinite(std::span<const float> x) noexcept PALPATE_NONBLOCKING;

/// y = (1 - share) y + share from. @param from  at least as long as y. Real-time: yes.
void mixInto(std::span<const float> from, float share, std::span<float> y) noexcept PALPATE_NONBLOCKING;

/// Rows that lie here and there: number r begins at A + stride * row[r], r < count.
struct Rows {
  const double* A;
  std::size_t stride;
  const std::int32_t* row;
  std::size_t count;
};

/// y = sum_r weight[r] * row r. @param length  of each row and y. Real-time: yes.
void mixRows(const Rows& rows, const double* weight, std::size_t length,
             double* y) noexcept PALPATE_NONBLOCKING;

/// out[r] = row r . y. @param length  of each row and y. Real-time: yes.
void dotRows(const Rows& rows, const double* y, std::size_t length, double* out) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
