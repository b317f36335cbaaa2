// SPDX-License-Identifier: Apache-2.0
#include "core/base/whole_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/base/whole_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#include "core/base/row_loops.h"

HWY_BEFORE_NAMESPACE();
namespace palpate {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// loop(first number), in one byte or two.
template <class Loop>
HWY_INLINE void asStored(const WholeNumbers& A, Loop loop) {
  if (A.int8() != nullptr)
    loop(A.int8());
  else
    loop(A.int16());
}

/// y += weight * row.
template <typename Number>
HWY_INLINE void addRow(const Number* row, float weight, std::size_t length, float* y) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto w = hn::Set(d, weight);
  std::size_t i = 0;
  for (; i + lanes <= length; i += lanes)
    hn::StoreU(hn::MulAdd(w, load(d, row + i), hn::LoadU(d, y + i)), d, y + i);
  for (; i < length; ++i) y[i] += weight * static_cast<float>(row[i]);
}

void AddRows(const ScaledRows& rows, const float* weight, float* y) {
  asStored(rows.A, [&](const auto* A) {
    if (rows.count == 1) return addRow(A, weight[0] * rows.scale[0], rows.length, y);
    mixAll<true>([&](std::size_t r) { return A + r * rows.length; },
                 [&](std::size_t r) { return weight[r] * rows.scale[r]; }, rows.count, rows.length, y);
  });
}

/// y[c] += sum over four rows of w[row][c] * row.
template <typename Number>
HWY_INLINE void addFourTogether(const Number* const (&a)[4], const float (&w)[4][kTogether],
                                std::size_t length, float* y) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= length; i += lanes) {
    const auto a0 = load(d, a[0] + i), a1 = load(d, a[1] + i), a2 = load(d, a[2] + i), a3 = load(d, a[3] + i);
    for (std::size_t c = 0; c < kTogether; ++c) {
      float* const to = y + c * length + i;
      const auto even = hn::MulAdd(hn::Set(d, w[0][c]), a0, hn::Mul(hn::Set(d, w[2][c]), a2));
      const auto odd =
          hn::MulAdd(hn::Set(d, w[1][c]), a1, hn::MulAdd(hn::Set(d, w[3][c]), a3, hn::LoadU(d, to)));
      hn::StoreU(hn::Add(even, odd), d, to);
    }
  }
  for (; i < length; ++i)
    for (std::size_t c = 0; c < kTogether; ++c)
      for (std::size_t k = 0; k < 4; ++k) y[c * length + i] += w[k][c] * static_cast<float>(a[k][i]);
}

template <typename Number>
HWY_INLINE void addRowsTogetherOf(const Number* A, const ScaledRows& rows, const float* weight, float* y) {
  for (std::size_t r = 0; r < rows.count; r += 4) {
    const Number* a[4];
    float w[4][kTogether];
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t row = std::min(r + k, rows.count - 1);
      a[k] = A + row * rows.length;
      const float scale = r + k < rows.count ? rows.scale[row] : 0.0F;
      for (std::size_t c = 0; c < kTogether; ++c) w[k][c] = scale * weight[kTogether * row + c];
    }
    addFourTogether(a, w, rows.length, y);
  }
}

void AddRowsTogether(const ScaledRows& rows, const float* weight, float* y) {
  asStored(rows.A, [&](const auto* A) { addRowsTogetherOf(A, rows, weight, y); });
}

template <typename Number>
HWY_INLINE void addGroupsOf(const Number* A, const PlacedGroups& groups, const double* weight, float* y) {
  for (std::size_t r = 0; r < groups.rows; ++r) {
    const auto rowOf = [&](std::size_t i) {
      return groups.rows * static_cast<std::size_t>(groups.number[i]) + r;
    };
    mixAll<true>([&](std::size_t i) { return A + rowOf(i) * groups.length; },
                 [&](std::size_t i) { return static_cast<float>(weight[i]) * groups.scale[rowOf(i)]; },
                 groups.count, groups.length, y + r * groups.length);
  }
}

void AddGroups(const PlacedGroups& groups, const double* weight, float* y) {
  asStored(groups.A, [&](const auto* A) { addGroupsOf(A, groups, weight, y); });
}

/// `from` has kNodeFloats numbers, of which those behind a matrix have weight 0.
template <typename Number>
HWY_INLINE void addMatrix(const Number* from, const float* weight, float* to) {
  const hn::CappedTag<float, kNodeFloats> d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t k = 0; k < kMatrixNumbers; k += lanes)
    hn::StoreU(hn::MulAdd(hn::LoadU(d, weight + k), load(d, from + k), hn::LoadU(d, to + k)), d, to + k);
}

template <typename Number>
HWY_INLINE void addMatricesOf(const Number* field, const std::int32_t* node, std::size_t count,
                              const float* weight, float* u) {
  const auto at = [&](std::size_t i) { return u + kNodeFloats * static_cast<std::size_t>(node[i]); };
  if (count == 0) return;
  // The vector that ends a matrix reads into the next one; the last has none behind it.
  static_assert(2 * kMatrixNumbers >= kNodeFloats);
  for (std::size_t i = 0; i + 1 < count; ++i) addMatrix(field + kMatrixNumbers * i, weight, at(i));
  Number last[kNodeFloats] = {};
  std::copy_n(field + kMatrixNumbers * (count - 1), kMatrixNumbers, last);
  addMatrix(last, weight, at(count - 1));
}

void AddMatrices(const WholeNumbers& field, const std::int32_t* node, std::size_t count,
                 const std::array<float, kNodeFloats>& weight, float* u) {
  asStored(field, [&](const auto* first) { addMatricesOf(first, node, count, weight.data(), u); });
}

void MixWholeRowsTogether(const PlacedWholes& rows, const float* weight, float* y) {
  asStored(rows.A, [&](const auto* A) {
    mixRowsTogetherOf(PlacedRows<decltype(A)>{A, rows.length, rows.row, rows.count}, weight, y);
  });
}

/// Four dot products at a time with numbers that lie behind their rows as well, times zeros of a copy of y.
/// @return how many rows: as long as the last of four has as many numbers behind it
template <typename Number>
HWY_INLINE std::size_t dotBeyond(const Number* A, const float* y, std::size_t rows, std::size_t length,
                                 float* out) {
  constexpr std::size_t kMost = 1024;
  const std::size_t step = 2 * hn::Lanes(hn::ScalableTag<float>()),
                    padded_length = (length + step - 1) / step * step;
  if (length == 0 || padded_length > kMost || rows <= 4) return 0;  // fewer are not worth a copy of y
  HWY_ALIGN float padded[kMost];
  std::fill(std::copy_n(y, length, padded), padded + padded_length, 0.0F);
  std::size_t r = 0;
  for (; r + 4 <= rows && (r + 3) * length + padded_length <= rows * length; r += 4) {
    const Number* const a[4] = {A + r * length, A + (r + 1) * length, A + (r + 2) * length,
                                A + (r + 3) * length};
    float four[4];
    dotFour(a, padded, padded_length, four);
    std::copy_n(four, 4, out + r);
  }
  return r;
}

#if HWY_TARGET == HWY_WASM
/// y as whole numbers of 31 bits in two halves: y = unit * (2^15 high + low), and zeros behind them.
struct Halves {
  static constexpr std::size_t kMost = 1024;  // so that no sum of products with bytes exceeds 32 bits
  HWY_ALIGN std::int16_t high[kMost]{}, low[kMost]{};
  double unit{0.0};

  /// @param most  the largest of abs(y), > 0
  Halves(const float* y, std::size_t length, float most) : unit(most / kLargest) {
    for (std::size_t i = 0; i < length; ++i) {
      const auto whole = static_cast<std::int32_t>(std::lrint(y[i] / unit));
      high[i] = static_cast<std::int16_t>((whole + 16384) >> 15);
      low[i] = static_cast<std::int16_t>(whole - (std::int32_t{high[i]} << 15));
    }
  }

 private:
  static constexpr double kLargest = 32767.0 * 32768.0;
};

/// Bytes eight at a time, in whole numbers; as floats they are widened twice and four at a time. The last eight numbers of a row
/// may lie in the next one, times zeros. @return how many rows: all but those at the end that have too few numbers behind them
HWY_INLINE std::size_t dotBeyond(const std::int8_t* A, const float* y, std::size_t rows, std::size_t length,
                                 float* out) {
  const std::size_t padded_length = (length + 7) / 8 * 8;
  if (padded_length > Halves::kMost || rows <= 4) return 0;
  float most = 0.0F;
  for (std::size_t i = 0; i < length; ++i) {
    if (!std::isfinite(y[i])) return 0;
    most = std::max(most, std::abs(y[i]));
  }
  if (most == 0.0F) return 0;
  const Halves halves(y, length, most);
  std::size_t r = 0;
  for (; r < rows && r * length + padded_length <= rows * length; ++r) {
    v128_t high = wasm_i32x4_splat(0), low = high;
    for (std::size_t i = 0; i < padded_length; i += 8) {
      const v128_t a = wasm_i16x8_load8x8(A + r * length + i);
      high = wasm_i32x4_add(high, wasm_i32x4_dot_i16x8(a, wasm_v128_load(halves.high + i)));
      low = wasm_i32x4_add(low, wasm_i32x4_dot_i16x8(a, wasm_v128_load(halves.low + i)));
    }
    const auto sum = [](v128_t v) {
      return std::int64_t{wasm_i32x4_extract_lane(v, 0)} + wasm_i32x4_extract_lane(v, 1) +
             wasm_i32x4_extract_lane(v, 2) + wasm_i32x4_extract_lane(v, 3);
    };
    out[r] = static_cast<float>(halves.unit * static_cast<double>((sum(high) << 15) + sum(low)));
  }
  return r;
}
#endif

void DotWholeRows(const WholeNumbers& A, const float* y, std::size_t rows, std::size_t length, float* out) {
  asStored(A, [&](const auto* first) {
    const std::size_t done = dotBeyond(first, y, rows, length, out);
    dotAll([=](std::size_t r) { return first + (done + r) * length; }, y, rows - done, length, out + done);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace palpate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate {

PALPATE_TRUSTED_BEGIN  // as in kernels.cpp

    HWY_EXPORT(AddRows);
HWY_EXPORT(AddRowsTogether);
HWY_EXPORT(AddGroups);
HWY_EXPORT(AddMatrices);
HWY_EXPORT(MixWholeRowsTogether);
HWY_EXPORT(DotWholeRows);

void addRows(const ScaledRows& rows, const float* weight, float* y) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(AddRows)(rows, weight, y);
}

void addRowsTogether(const ScaledRows& rows, const float* weight, float* y) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(AddRowsTogether)(rows, weight, y);
}

void addGroups(const PlacedGroups& groups, const double* weight, float* y) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(AddGroups)(groups, weight, y);
}

void addMatrices(const WholeNumbers& field, const std::int32_t* node, std::size_t count,
                 const std::array<float, kNodeFloats>& weight, float* u) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(AddMatrices)(field, node, count, weight, u);
}

void mixRowsTogether(const PlacedWholes& rows, const float* weight, float* y) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(MixWholeRowsTogether)(rows, weight, y);
}

void dotRows(const WholeNumbers& A, const float* y, std::size_t rows, std::size_t length,
             float* out) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(DotWholeRows)(A, y, rows, length, out);
}

PALPATE_TRUSTED_END

}  // namespace palpate
#endif
