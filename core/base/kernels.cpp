// SPDX-License-Identifier: Apache-2.0
#include "core/base/kernels.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

// Compiled once for each instruction set; the first call finds the best that the processor has.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/base/kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway asks.
#include <hwy/highway.h>

#include "core/base/row_loops.h"

HWY_BEFORE_NAMESPACE();
namespace palpate {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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

void MixRowsTogether(const PlacedFloats& rows, const float* weight, float* y) {
  mixRowsTogetherOf(rows, weight, y);
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
