// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/pack_modes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::modelfile {

namespace {

/// So that the largest number becomes `top`. Of a mode that moves nothing it is next to nothing, not 1: weights are
/// whole numbers over the sum of all amplitudes times scales.
float scaleFor(std::span<const float> mode, float top) {
  float most = 0.0F;
  for (const float value : mode) most = std::max(most, std::abs(value));
  return std::max(most / top, kLeastScale);
}

void packInt16(std::span<const float> mode, std::size_t row, const ModeCounts& counts, PackedModesData& to) {
  const float scale = scaleFor(mode, 32767.0F);
  to.scale.push_back(scale);
  for (std::size_t i = 0; i < std::min(mode.size(), to.tiles * kTile); ++i) {
    const std::size_t pair = (i / kTile * counts.pairs() + row / 2) * kTile + i % kTile;
    const float number = std::clamp(std::nearbyint(mode[i] / scale), -32767.0F, 32767.0F);
    to.X16[2 * pair + row % 2] = static_cast<std::int16_t>(number);
  }
}

/// The bytes of one number of all modes in bytes.
class Place {
 public:
  Place(const ModeCounts& counts, std::size_t i, PackedModesData& to)
      : bytes_(to.X8.data() + ((i / kTile * counts.quads()) * kTile + i % kTile) * 4) {}
  void set(std::size_t slot, int number) {
    bytes_[slot / 4 * kTile * 4 + slot % 4] = static_cast<std::uint8_t>(128 + std::clamp(number, -128, 127));
  }

 private:
  std::uint8_t* bytes_;
};

/// Modes that share a byte, in steps of their own bytes: x_j = own_j + share_j / 256 * shared. Modulo 1 the mode with
/// the largest share sees the lowest bits of the shared byte only, and the next one sees those and as many more: so
/// each chooses its bits knowing those below.
/// @return what is shared, -128 to 127
int sharedOf(std::span<const float> x, std::span<const int> share) {
  int bits = 0, known = 1;  // `bits` is chosen modulo `known`
  for (std::size_t j = x.size(); j-- > 0;) {
    const int period = 256 / share[j];
    const float wanted =
        (static_cast<float>(period) * x[j] - static_cast<float>(bits)) / static_cast<float>(known);
    const int choices = period / known;
    const int choice = static_cast<int>(std::lround(wanted)) % choices;
    bits += known * (choice < 0 ? choice + choices : choice);
    known = period;
  }
  return bits < 128 ? bits : bits - 256;
}

/// Tiles up to the last number that is not zero in all modes.
std::size_t tilesFor(std::span<const float> X, std::size_t numbers) {
  std::size_t end = 0;
  for (std::size_t row = 0; row < X.size(); row += numbers)
    for (std::size_t i = numbers; i > end; --i)
      if (X[row + i - 1] != 0.0F) end = i;
  return tilesOf(end);
}

/// Modes [row, row + count) of those in bytes, which share a byte, or one mode that shares none.
void packGroup(std::span<const float> X, std::size_t numbers, std::size_t row, std::size_t count,
               const ModeCounts& counts, PackedModesData& to) {
  std::array<int, 4> share{};
  std::array<float, 4> per_step{}, x{};
  for (std::size_t j = 0; j < count; ++j) {
    share[j] = sharedByte(counts, row + j).share;
    const float room =
        share[j] == 0 ? 0.0F : 0.5F * static_cast<float>(share[j]) + 0.5F;  // for what is shared
    to.scale.push_back(scaleFor(X.subspan((row + j) * numbers, numbers), 127.0F - room));
    per_step[j] = 1.0F / to.scale.back();
  }
  for (std::size_t i = 0; i < std::min(numbers, to.tiles * kTile); ++i) {
    Place place(counts, i, to);
    for (std::size_t j = 0; j < count; ++j) x[j] = X[(row + j) * numbers + i] * per_step[j];
    const int shared = share[0] == 0 ? 0 : sharedOf(std::span(x).first(count), share);
    if (share[0] != 0) place.set(sharedByte(counts, row).slot, shared);
    for (std::size_t j = 0; j < count; ++j) {
      const float below = static_cast<float>(share[j] * shared) / 256.0F;
      place.set(row + j, static_cast<int>(std::lround(x[j] - below)));
    }
  }
}

}  // namespace

PackedModesData packModes(std::span<const float> X, std::size_t numbers, const ModeCounts& counts) {
  PackedModesData packed;
  packed.tiles = tilesFor(X.subspan(counts.f32 * numbers), numbers);
  packed.X16.assign(packed.tiles * counts.pairs() * kTile * 2, 0);
  packed.X8.assign(packed.tiles * counts.quads() * kTile * 4, 128);
  for (const std::size_t modes : {counts.i16, counts.bits10, counts.bits8})
    packed.kinds.push_back(static_cast<std::int32_t>(modes));
  for (std::size_t row = 0; row < counts.i16; ++row)
    packInt16(X.subspan((counts.f32 + row) * numbers, numbers), row, counts, packed);
  const auto in_bytes = X.subspan((counts.f32 + counts.i16) * numbers);
  for (std::size_t row = 0; row < counts.inBytes();) {
    const std::size_t end = row < counts.bits10 ? std::min(row + 4, counts.bits10) : row + 1;
    packGroup(in_bytes, numbers, row, end - row, counts, packed);
    row = end;
  }
  return packed;
}

}  // namespace palpate::modelfile
