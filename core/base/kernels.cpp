// SPDX-License-Identifier: Apache-2.0
#include "core/base/kernels.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>

// Compiled once for each instruction set; the first call finds the best that the processor has.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/base/kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace palpate {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Whether the processor has vectors of T: WebAssembly has none of doubles here, and loops go number by number.
template <typename T>
constexpr bool kHasVectors = HWY_HAVE_FLOAT64 != 0 || !std::is_same_v<T, double>;

/// A vector of a row: as it lies, or whole numbers made floats.
template <class D, typename Number>
HWY_INLINE hn::Vec<D> load(D d, const Number* from) {
  if constexpr (hwy::IsSame<Number, hn::TFromD<D>>())
    return hn::LoadU(d, from);
  else
    return hn::ConvertTo(d, hn::PromoteTo(hn::RebindToSigned<D>(), hn::LoadU(hn::Rebind<Number, D>(), from)));
}

/// y = base + sum over four rows of weight * row; base is y or zero.
template <bool kOntoY, typename Number, typename T>
HWY_INLINE void mixFour(const Number* const (&a)[4], const T (&w)[4], std::size_t length, T* y) {
  std::size_t i = 0;
  if constexpr (kHasVectors<T>) {
    const hn::ScalableTag<T> d;
    const std::size_t lanes = hn::Lanes(d);
    const auto w0 = hn::Set(d, w[0]), w1 = hn::Set(d, w[1]), w2 = hn::Set(d, w[2]), w3 = hn::Set(d, w[3]);
    for (; i + lanes <= length; i += lanes) {
      const auto base = kOntoY ? hn::LoadU(d, y + i) : hn::Zero(d);
      const auto even = hn::MulAdd(w0, load(d, a[0] + i), hn::Mul(w2, load(d, a[2] + i)));
      const auto odd = hn::MulAdd(w1, load(d, a[1] + i), hn::MulAdd(w3, load(d, a[3] + i), base));
      hn::StoreU(hn::Add(even, odd), d, y + i);
    }
  }
  for (; i < length; ++i)
    y[i] = (kOntoY ? y[i] : T{0}) + ((w[0] * a[0][i] + w[2] * a[2][i]) + (w[1] * a[1][i] + w[3] * a[3][i]));
}

/// Four rows at a time: one pass over y for four over the rows. What is missing of the last four has weight 0.
template <bool kOntoY, typename T, typename RowAt, typename WeightOf>
HWY_INLINE void mixAll(RowAt rowAt, WeightOf weightOf, std::size_t rows, std::size_t length, T* y) {
  for (std::size_t r = 0; r < rows; r += 4) {
    decltype(rowAt(r)) a[4];
    T w[4];
    for (std::size_t k = 0; k < 4; ++k) {
      a[k] = rowAt(std::min(r + k, rows - 1));
      w[k] = r + k < rows ? weightOf(r + k) : T{0};
    }
    if (kOntoY || r > 0)
      mixFour<true>(a, w, length, y);
    else
      mixFour<false>(a, w, length, y);
  }
}

/// Four dot products at a time, each in two partial sums, so that the additions need not wait for each other.
template <typename T>
HWY_INLINE void dotFour(const T* const (&a)[4], const T* y, std::size_t length, T (&out)[4]) {
  std::size_t i = 0;
  for (T& sum : out) sum = T{0};
  if constexpr (kHasVectors<T>) {
    const hn::ScalableTag<T> d;
    const std::size_t lanes = hn::Lanes(d);
    auto s0 = hn::Zero(d), s1 = hn::Zero(d), s2 = hn::Zero(d), s3 = hn::Zero(d);
    auto t0 = hn::Zero(d), t1 = hn::Zero(d), t2 = hn::Zero(d), t3 = hn::Zero(d);
    for (; i + 2 * lanes <= length; i += 2 * lanes) {
      const auto near = hn::LoadU(d, y + i), far = hn::LoadU(d, y + i + lanes);
      s0 = hn::MulAdd(hn::LoadU(d, a[0] + i), near, s0);
      s1 = hn::MulAdd(hn::LoadU(d, a[1] + i), near, s1);
      s2 = hn::MulAdd(hn::LoadU(d, a[2] + i), near, s2);
      s3 = hn::MulAdd(hn::LoadU(d, a[3] + i), near, s3);
      t0 = hn::MulAdd(hn::LoadU(d, a[0] + i + lanes), far, t0);
      t1 = hn::MulAdd(hn::LoadU(d, a[1] + i + lanes), far, t1);
      t2 = hn::MulAdd(hn::LoadU(d, a[2] + i + lanes), far, t2);
      t3 = hn::MulAdd(hn::LoadU(d, a[3] + i + lanes), far, t3);
    }
    out[0] = hn::GetLane(hn::SumOfLanes(d, hn::Add(s0, t0)));
    out[1] = hn::GetLane(hn::SumOfLanes(d, hn::Add(s1, t1)));
    out[2] = hn::GetLane(hn::SumOfLanes(d, hn::Add(s2, t2)));
    out[3] = hn::GetLane(hn::SumOfLanes(d, hn::Add(s3, t3)));
  }
  for (; i < length; ++i)
    for (std::size_t k = 0; k < 4; ++k) out[k] += a[k][i] * y[i];
}

template <typename T, typename RowAt>
HWY_INLINE void dotAll(RowAt rowAt, const T* y, std::size_t rows, std::size_t length, T* out) {
  for (std::size_t r = 0; r < rows; r += 4) {
    const T* a[4];
    T four[4];
    for (std::size_t k = 0; k < 4; ++k) a[k] = rowAt(std::min(r + k, rows - 1));
    dotFour(a, y, length, four);
    for (std::size_t k = 0; k < 4 && r + k < rows; ++k) out[r + k] = four[k];
  }
}

void AddRows(const ScaledRows& rows, const float* weight, float* y) {
  mixAll<true>([&](std::size_t r) { return rows.A + r * rows.length; },
               [&](std::size_t r) { return weight[r] * rows.scale[r]; }, rows.count, rows.length, y);
}

/// y[c] += sum over four rows of w[row][c] * row.
HWY_INLINE void addFourTogether(const std::int16_t* const (&a)[4], const float (&w)[4][kTogether],
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

void AddRowsTogether(const ScaledRows& rows, const float* weight, float* y) {
  for (std::size_t r = 0; r < rows.count; r += 4) {
    const std::int16_t* a[4];
    float w[4][kTogether];
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t row = std::min(r + k, rows.count - 1);
      a[k] = rows.A + row * rows.length;
      const float scale = r + k < rows.count ? rows.scale[row] : 0.0F;
      for (std::size_t c = 0; c < kTogether; ++c) w[k][c] = scale * weight[kTogether * row + c];
    }
    addFourTogether(a, w, rows.length, y);
  }
}

void AddGroups(const PlacedGroups& groups, const double* weight, float* y) {
  for (std::size_t r = 0; r < groups.rows; ++r) {
    const auto rowOf = [&](std::size_t i) {
      return groups.rows * static_cast<std::size_t>(groups.number[i]) + r;
    };
    mixAll<true>([&](std::size_t i) { return groups.A + rowOf(i) * groups.length; },
                 [&](std::size_t i) { return static_cast<float>(weight[i]) * groups.scale[rowOf(i)]; },
                 groups.count, groups.length, y + r * groups.length);
  }
}

void AddWholeVectors(const std::int16_t* field, const std::int32_t* node, std::size_t count,
                     const std::array<float, kNodeFloats>& weight, float* u) {
  const hn::CappedTag<float, kNodeFloats> d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < count; ++i) {
    const std::int16_t* const from = field + kThreeVectors * i;
    float* const to = u + kNodeFloats * static_cast<std::size_t>(node[i]);
    for (std::size_t k = 0; k < kThreeVectors; k += lanes)
      hn::StoreU(hn::MulAdd(hn::LoadU(d, weight.data() + k), load(d, from + k), hn::LoadU(d, to + k)), d,
                 to + k);
  }
}

void AddVectors(const float* y, const std::int32_t* node, std::size_t count, float factor, float* u) {
  const hn::CappedTag<float, 4> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto times = hn::Set(d, factor);
  for (std::size_t i = 0; i < count; ++i) {
    float* const to = u + kNodeFloats * static_cast<std::size_t>(node[i]);
    for (std::size_t c = 0; c < kTogether; ++c)
      for (std::size_t k = 0; k < 4; k += lanes)
        hn::StoreU(hn::MulAdd(times, hn::LoadU(d, y + 3 * (c * count + i) + k), hn::LoadU(d, to + 4 * c + k)),
                   d, to + 4 * c + k);
  }
}

void AddScaled(const float* from, float factor, std::size_t length, float* y) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto times = hn::Set(d, factor);
  std::size_t i = 0;
  for (; i + lanes <= length; i += lanes)
    hn::StoreU(hn::MulAdd(times, hn::LoadU(d, from + i), hn::LoadU(d, y + i)), d, y + i);
  for (; i < length; ++i) y[i] += factor * from[i];
}

template <class D>
HWY_INLINE void mixTogetherAt(D d, const PlacedFloats& rows, const float* weight, std::size_t i, float* y) {
  auto s0 = hn::Zero(d), s1 = hn::Zero(d), s2 = hn::Zero(d), s3 = hn::Zero(d);
  for (std::size_t r = 0; r < rows.count; ++r, weight += kTogether) {
    const auto a = hn::LoadU(d, rows.A + rows.length * static_cast<std::size_t>(rows.row[r]) + i);
    s0 = hn::MulAdd(hn::Set(d, weight[0]), a, s0);
    s1 = hn::MulAdd(hn::Set(d, weight[1]), a, s1);
    s2 = hn::MulAdd(hn::Set(d, weight[2]), a, s2);
    s3 = hn::MulAdd(hn::Set(d, weight[3]), a, s3);
  }
  hn::StoreU(s0, d, y + i);
  hn::StoreU(s1, d, y + rows.length + i);
  hn::StoreU(s2, d, y + 2 * rows.length + i);
  hn::StoreU(s3, d, y + 3 * rows.length + i);
}

/// Two vectors of each sum side by side, so that the additions need not wait for each other.
template <class D>
HWY_INLINE void mixTwoTogetherAt(D d, const PlacedFloats& rows, const float* weight, std::size_t i,
                                 float* y) {
  const std::size_t lanes = hn::Lanes(d);
  auto s0 = hn::Zero(d), s1 = hn::Zero(d), s2 = hn::Zero(d), s3 = hn::Zero(d);
  auto t0 = hn::Zero(d), t1 = hn::Zero(d), t2 = hn::Zero(d), t3 = hn::Zero(d);
  for (std::size_t r = 0; r < rows.count; ++r, weight += kTogether) {
    const float* const from = rows.A + rows.length * static_cast<std::size_t>(rows.row[r]) + i;
    const auto a = hn::LoadU(d, from), b = hn::LoadU(d, from + lanes);
    const auto w0 = hn::Set(d, weight[0]), w1 = hn::Set(d, weight[1]), w2 = hn::Set(d, weight[2]),
               w3 = hn::Set(d, weight[3]);
    s0 = hn::MulAdd(w0, a, s0), t0 = hn::MulAdd(w0, b, t0);
    s1 = hn::MulAdd(w1, a, s1), t1 = hn::MulAdd(w1, b, t1);
    s2 = hn::MulAdd(w2, a, s2), t2 = hn::MulAdd(w2, b, t2);
    s3 = hn::MulAdd(w3, a, s3), t3 = hn::MulAdd(w3, b, t3);
  }
  const auto store = [&](std::size_t c, hn::Vec<D> one, hn::Vec<D> other) {
    hn::StoreU(one, d, y + c * rows.length + i);
    hn::StoreU(other, d, y + c * rows.length + i + lanes);
  };
  store(0, s0, t0), store(1, s1, t1), store(2, s2, t2), store(3, s3, t3);
}

void MixRowsTogether(const PlacedFloats& rows, const float* weight, float* y) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + 2 * lanes <= rows.length; i += 2 * lanes) mixTwoTogetherAt(d, rows, weight, i, y);
  for (; i + lanes <= rows.length; i += lanes) mixTogetherAt(d, rows, weight, i, y);
  for (; i < rows.length; ++i) mixTogetherAt(hn::CappedTag<float, 1>(), rows, weight, i, y);
}

bool AllFinite(const float* x, std::size_t length) {
  const hn::ScalableTag<float> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const std::size_t lanes = hn::Lanes(d);
  // Of the bits without sign: a number has an exponent below the last.
  auto most = hn::Zero(du), others = hn::Zero(du);
  const auto amount = hn::Set(du, 0x7FFFFFFFU);
  const auto bitsAt = [&](std::size_t i) { return hn::And(hn::BitCast(du, hn::LoadU(d, x + i)), amount); };
  std::size_t i = 0;
  for (; i + 2 * lanes <= length; i += 2 * lanes) {
    most = hn::Max(most, bitsAt(i));
    others = hn::Max(others, bitsAt(i + lanes));
  }
  std::uint32_t largest = hn::GetLane(hn::MaxOfLanes(du, hn::Max(most, others)));
  for (; i < length; ++i) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, x + i, sizeof bits);
    largest = std::max(largest, bits & 0x7FFFFFFFU);
  }
  return largest < 0x7F800000U;
}

void MixInto(const float* from, float share, std::size_t length, float* y) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto old = hn::Set(d, share), now = hn::Set(d, 1.0F - share);
  std::size_t i = 0;
  for (; i + lanes <= length; i += lanes)
    hn::StoreU(hn::MulAdd(now, hn::LoadU(d, y + i), hn::Mul(old, hn::LoadU(d, from + i))), d, y + i);
  for (; i < length; ++i) y[i] = (1.0F - share) * y[i] + share * from[i];
}

void DotRows(const float* A, std::size_t stride, const float* y, std::size_t rows, std::size_t length,
             float* out) {
  dotAll([=](std::size_t r) { return A + r * stride; }, y, rows, length, out);
}

void MixPlacedRows(const Rows& rows, const double* weight, std::size_t length, double* y) {
  if (rows.count == 0) std::fill_n(y, length, 0.0);
  const auto rowAt = [&](std::size_t r) {
    return rows.A + rows.stride * static_cast<std::size_t>(rows.row[r]);
  };
  mixAll<false>(
      rowAt, [=](std::size_t r) { return weight[r]; }, rows.count, length, y);
}

void DotPlacedRows(const Rows& rows, const double* y, std::size_t length, double* out) {
  const auto rowAt = [&](std::size_t r) {
    return rows.A + rows.stride * static_cast<std::size_t>(rows.row[r]);
  };
  dotAll(rowAt, y, rows.count, length, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace palpate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate {

PALPATE_TRUSTED_BEGIN  // the table of instruction sets begins with a function that asks the processor, before the loop

    HWY_EXPORT(AddRows);
HWY_EXPORT(AddRowsTogether);
HWY_EXPORT(AddGroups);
HWY_EXPORT(AddWholeVectors);
HWY_EXPORT(AddVectors);
HWY_EXPORT(AddScaled);
HWY_EXPORT(MixRowsTogether);
HWY_EXPORT(DotRows);
HWY_EXPORT(AllFinite);
HWY_EXPORT(MixInto);
HWY_EXPORT(MixPlacedRows);
HWY_EXPORT(DotPlacedRows);

void chooseKernels() noexcept {
#if !HWY_ARCH_WASM  // which has one instruction set
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
#endif
}

void addRows(const ScaledRows& rows, const float* weight, float* y) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(AddRows)(rows, weight, y);
}

void addRowsTogether(const ScaledRows& rows, const float* weight, float* y) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(AddRowsTogether)(rows, weight, y);
}

void addGroups(const PlacedGroups& groups, const double* weight, float* y) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(AddGroups)(groups, weight, y);
}

void addVectors(const std::int16_t* field, const std::int32_t* node, std::size_t count,
                const std::array<float, kNodeFloats>& weight, float* u) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(AddWholeVectors)(field, node, count, weight, u);
}

void addVectors(const float* y, const std::int32_t* node, std::size_t count, float factor,
                float* u) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(AddVectors)(y, node, count, factor, u);
}

void addScaled(const float* from, float factor, std::span<float> y) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(AddScaled)(from, factor, y.size(), y.data());
}

void mixRowsTogether(const PlacedFloats& rows, const float* weight, float* y) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(MixRowsTogether)(rows, weight, y);
}

void dotRows(const float* A, std::size_t stride, const float* y, std::size_t rows, std::size_t length,
             float* out) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(DotRows)(A, stride, y, rows, length, out);
}

bool allFinite(std::span<const float> x) noexcept PALPATE_NONBLOCKING {
  return HWY_DYNAMIC_DISPATCH(AllFinite)(x.data(), x.size());
}

void mixInto(std::span<const float> from, float share, std::span<float> y) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(MixInto)(from.data(), share, y.size(), y.data());
}

void mixRows(const Rows& rows, const double* weight, std::size_t length,
             double* y) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(MixPlacedRows)(rows, weight, length, y);
}

void dotRows(const Rows& rows, const double* y, std::size_t length,
             double* out) noexcept PALPATE_NONBLOCKING {
  HWY_DYNAMIC_DISPATCH(DotPlacedRows)(rows, y, length, out);
}

PALPATE_TRUSTED_END

}  // namespace palpate
#endif
