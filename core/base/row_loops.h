// SPDX-License-Identifier: Apache-2.0
// Loops over rows that several kernels share. Read once for each instruction set, after core/base/kernels.h and hwy/highway.h.
#include <algorithm>
#include <cstddef>
#include <type_traits>

#if defined(PALPATE_CORE_BASE_ROW_LOOPS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PALPATE_CORE_BASE_ROW_LOOPS_H
#undef PALPATE_CORE_BASE_ROW_LOOPS_H
#else
#define PALPATE_CORE_BASE_ROW_LOOPS_H
#endif

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
template <typename Number, typename T>
HWY_INLINE void dotFour(const Number* const (&a)[4], const T* y, std::size_t length, T (&out)[4]) {
  std::size_t i = 0;
  for (T& sum : out) sum = T{0};
  if constexpr (kHasVectors<T>) {
    const hn::ScalableTag<T> d;
    const std::size_t lanes = hn::Lanes(d);
    auto s0 = hn::Zero(d), s1 = hn::Zero(d), s2 = hn::Zero(d), s3 = hn::Zero(d);
    auto t0 = hn::Zero(d), t1 = hn::Zero(d), t2 = hn::Zero(d), t3 = hn::Zero(d);
    for (; i + 2 * lanes <= length; i += 2 * lanes) {
      const auto near = hn::LoadU(d, y + i), far = hn::LoadU(d, y + i + lanes);
      s0 = hn::MulAdd(load(d, a[0] + i), near, s0);
      s1 = hn::MulAdd(load(d, a[1] + i), near, s1);
      s2 = hn::MulAdd(load(d, a[2] + i), near, s2);
      s3 = hn::MulAdd(load(d, a[3] + i), near, s3);
      t0 = hn::MulAdd(load(d, a[0] + i + lanes), far, t0);
      t1 = hn::MulAdd(load(d, a[1] + i + lanes), far, t1);
      t2 = hn::MulAdd(load(d, a[2] + i + lanes), far, t2);
      t3 = hn::MulAdd(load(d, a[3] + i + lanes), far, t3);
    }
    out[0] = hn::GetLane(hn::SumOfLanes(d, hn::Add(s0, t0)));
    out[1] = hn::GetLane(hn::SumOfLanes(d, hn::Add(s1, t1)));
    out[2] = hn::GetLane(hn::SumOfLanes(d, hn::Add(s2, t2)));
    out[3] = hn::GetLane(hn::SumOfLanes(d, hn::Add(s3, t3)));
  }
  for (; i < length; ++i)
    for (std::size_t k = 0; k < 4; ++k) out[k] += static_cast<T>(a[k][i]) * y[i];
}

template <typename T, typename RowAt>
HWY_INLINE void dotAll(RowAt rowAt, const T* y, std::size_t rows, std::size_t length, T* out) {
  for (std::size_t r = 0; r < rows; r += 4) {
    decltype(rowAt(r)) a[4];
    T four[4];
    for (std::size_t k = 0; k < 4; ++k) a[k] = rowAt(std::min(r + k, rows - 1));
    dotFour(a, y, length, four);
    for (std::size_t k = 0; k < 4 && r + k < rows; ++k) out[r + k] = four[k];
  }
}

template <class D, class Rows>
HWY_INLINE void mixTogetherAt(D d, const Rows& rows, const float* weight, std::size_t i, float* y) {
  auto s0 = hn::Zero(d), s1 = hn::Zero(d), s2 = hn::Zero(d), s3 = hn::Zero(d);
  for (std::size_t r = 0; r < rows.count; ++r, weight += kTogether) {
    const auto a = load(d, rows.A + rows.length * static_cast<std::size_t>(rows.row[r]) + i);
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
template <class D, class Rows>
HWY_INLINE void mixTwoTogetherAt(D d, const Rows& rows, const float* weight, std::size_t i, float* y) {
  const std::size_t lanes = hn::Lanes(d);
  auto s0 = hn::Zero(d), s1 = hn::Zero(d), s2 = hn::Zero(d), s3 = hn::Zero(d);
  auto t0 = hn::Zero(d), t1 = hn::Zero(d), t2 = hn::Zero(d), t3 = hn::Zero(d);
  for (std::size_t r = 0; r < rows.count; ++r, weight += kTogether) {
    const auto* const from = rows.A + rows.length * static_cast<std::size_t>(rows.row[r]) + i;
    const auto a = load(d, from), b = load(d, from + lanes);
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

template <class Rows>
HWY_INLINE void mixRowsTogetherOf(const Rows& rows, const float* weight, float* y) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + 2 * lanes <= rows.length; i += 2 * lanes) mixTwoTogetherAt(d, rows, weight, i, y);
  for (; i + lanes <= rows.length; i += lanes) mixTogetherAt(d, rows, weight, i, y);
  for (; i < rows.length; ++i) mixTogetherAt(hn::CappedTag<float, 1>(), rows, weight, i, y);
}

}  // namespace HWY_NAMESPACE
}  // namespace palpate
HWY_AFTER_NAMESPACE();
#endif
