// SPDX-License-Identifier: Apache-2.0
#include "core/model/byte_weights.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/model/byte_weights.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace palpate {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using Shorts = hn::Rebind<std::int16_t, Floats>;

void FindAmounts(const float* x, std::size_t length, Amounts& amounts) {
  const Floats d;
  auto sum = hn::Zero(d), most = hn::Zero(d);
  for (std::size_t i = 0; i < length; i += hn::Lanes(d)) {
    const auto amount = hn::Abs(hn::LoadU(d, x + i));
    sum = hn::Add(sum, amount);
    most = hn::Max(most, amount);
  }
  amounts = {hn::GetLane(hn::SumOfLanes(d, sum)), hn::GetLane(hn::MaxOfLanes(d, most))};
}

/// The p whose multiple of `ratio` is nearest to a whole number.
template <typename V>
HWY_INLINE V bestOf(V ratio) {
  const Floats d;
  constexpr int kTried = 16;  // one ratio in eight then leaves more than 1 / 1280 of the amplitude
  const auto one = hn::Set(d, 1.0F);
  auto p = hn::Min(hn::Floor(hn::Div(hn::Set(d, 128.0F), hn::Add(one, ratio))), hn::Set(d, 127.0F));
  auto best = p, least = one;
  for (int i = 0; i < kTried; ++i) {
    const auto q = hn::Mul(ratio, p);
    const auto error = hn::Abs(hn::Sub(q, hn::Round(q)));
    best = hn::IfThenElse(hn::Lt(error, least), p, best);
    least = hn::Min(error, least);
    p = hn::Sub(p, one);
  }
  return best;
}

void WeighPairs(const BytePairs& pairs, std::size_t count, float unit, std::int32_t& products) {
  const Floats d;
  const Ints di;
  const Shorts ds;
  const auto units = hn::Set(d, unit), per_unit = hn::Set(d, 1.0F / unit), tiny = hn::Set(d, 1e-37F);
  auto sum = hn::Zero(di);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto a = hn::LoadU(d, pairs.even + i), b = hn::LoadU(d, pairs.odd + i);
    const auto size_a = hn::Abs(a), size_b = hn::Abs(b);
    const auto large = hn::Max(size_a, size_b);
    const auto ratio = hn::Div(hn::Min(size_a, size_b), hn::Max(large, tiny));
    const auto p = bestOf(ratio), q = hn::Round(hn::Mul(ratio, p));
    const auto weight = hn::Round(hn::Div(hn::Mul(large, per_unit), p));
    const auto a_first = hn::Ge(size_a, size_b);
    const auto byte_a = hn::CopySign(hn::IfThenElse(a_first, p, q), a);
    const auto byte_b = hn::CopySign(hn::IfThenElse(a_first, q, p), b);
    const auto step = hn::Mul(units, weight);
    const auto left_a = hn::NegMulAdd(step, byte_a, a), left_b = hn::NegMulAdd(step, byte_b, b);
    hn::StoreU(left_a, d, pairs.even + i);
    hn::StoreU(left_b, d, pairs.odd + i);
    hn::StoreU(hn::Max(hn::Abs(left_a), hn::Abs(left_b)), d, pairs.left + i);
    const auto whole_a = hn::ConvertTo(di, byte_a), whole_b = hn::ConvertTo(di, byte_b);
    const auto whole_weight = hn::ConvertTo(di, weight);
    const auto both = hn::Or(hn::ShiftLeft<8>(whole_b), hn::And(whole_a, hn::Set(di, 255)));
    hn::StoreU(hn::DemoteTo(ds, both), ds, pairs.bytes + i);
    hn::StoreU(hn::DemoteTo(ds, whole_weight), ds, pairs.weight + i);
    sum = hn::Add(sum, hn::Mul(whole_weight, hn::Add(whole_a, whole_b)));
  }
  products = hn::GetLane(hn::SumOfLanes(di, sum));
}

}  // namespace HWY_NAMESPACE
}  // namespace palpate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate {

PALPATE_TRUSTED_BEGIN  // as in kernels.cpp

    HWY_EXPORT(FindAmounts);
HWY_EXPORT(WeighPairs);

Amounts amountsOf(const float* x, std::size_t length) noexcept PALPATE_NONBLOCKING {
  Amounts amounts;
  HWY_DYNAMIC_DISPATCH(FindAmounts)(x, length, amounts);
  return amounts;
}

std::int32_t weighPairs(const BytePairs& pairs, std::size_t count, float unit) noexcept PALPATE_NONBLOCKING {
  std::int32_t products = 0;
  HWY_DYNAMIC_DISPATCH(WeighPairs)(pairs, count, unit, products);
  return products;
}

PALPATE_TRUSTED_END

}  // namespace palpate
#endif
