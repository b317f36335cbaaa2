// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/kernels.h"
#include "core/base/whole_numbers.h"

namespace palpate {

// Kernels over whole numbers of one byte or two, which become floats as they are read.

/// Rows of whole numbers that follow each other, with a scale each: number i of row r is scale[r] * A[r * length + i].
struct ScaledRows {
  WholeNumbers A;
  const float* scale;
  std::size_t count;
  std::size_t length;
};

/// y += sum_r weight[r] * row r. y stays in the first-level cache while A streams past once. Real-time: yes.
void addRows(const ScaledRows& rows, const float* weight, float* y) noexcept PALPATE_NONBLOCKING;

/// y[c] += sum_r weight[r][c] * row r. @param weight  [count][kTogether]  @param y  [kTogether][length]. Real-time: yes.
void addRowsTogether(const ScaledRows& rows, const float* weight, float* y) noexcept PALPATE_NONBLOCKING;

/// Groups of rows of whole numbers, as many in each, here and there: `rows` rows of group number[i], i < count.
struct PlacedGroups {
  WholeNumbers A;
  const float* scale;
  std::size_t rows;
  std::size_t length;
  const std::int32_t* number;
  std::size_t count;
};

/// y[r] += sum_i weight[i] * row r of group i. @param y  [rows][length]. Real-time: yes.
void addGroups(const PlacedGroups& groups, const double* weight, float* y) noexcept PALPATE_NONBLOCKING;

/// Numbers of a node's matrix.
inline constexpr std::size_t kMatrixNumbers = 9;

/// u[node[i]] += weight * field[i], number by number of matrices. @param field  [count][kMatrixNumbers]
/// @param weight  of each number, and zeros behind  @param u  [Ns][kNodeFloats]. Real-time: yes.
void addMatrices(const WholeNumbers& field, const std::int32_t* node, std::size_t count,
                 const std::array<float, kNodeFloats>& weight, float* u) noexcept PALPATE_NONBLOCKING;

using PlacedWholes = PlacedRows<WholeNumbers>;

/// y[c] = sum_r weight[r][c] * row r. @param weight  [count][kTogether]  @param y  [kTogether][length]. Real-time: yes.
void mixRowsTogether(const PlacedWholes& rows, const float* weight, float* y) noexcept PALPATE_NONBLOCKING;

/// out[r] = sum over i < length of A[r * length + i] * y[i], r < rows. Real-time: yes.
void dotRows(const WholeNumbers& A, const float* y, std::size_t rows, std::size_t length,
             float* out) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
