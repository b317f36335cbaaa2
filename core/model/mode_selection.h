// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.h"
#include "core/data/packed_modes.h"

namespace palpate {

/// Whole-number weights of two modes, as they are multiplied by one instruction.
using WeightPair = std::array<std::int16_t, 2>;

/// Weights of a quad of bytes: byte k counts pair[k / 2] * byte[k]. Two bytes with their weights fit sixteen bits, as
/// the amounts of the weights add up to at most 128.
struct QuadWeights {
  std::array<std::int8_t, 4> byte{};
  WeightPair pair{};
};

/// The packed modes that a field needs at its amplitudes y, and their weights: whole numbers, small enough that a sum
/// of products fits 32 bits. A quad may come twice. Scratch of one thread, allocated before the loop.
class ModeSelection {
 public:
  explicit ModeSelection(const ModeCounts& counts);

  /// Leaves out pairs and quads of modes that cannot be seen: those with the smallest sums of |y_k| peak_k, as many as
  /// add up to at most `unseen`, found by half octaves. That bounds what leaving them out costs at any node.
  /// @param y  [n] m  @param peak  [n] largest displacement of a node in each mode  @param packed  the modes
  /// @param unseen  m; 0 leaves out nothing  Cost O(n). Real-time: yes.
  void choose(std::span<const float> y, std::span<const float> peak, const PackedModes& packed,
              float unseen) noexcept PALPATE_NONBLOCKING;

  /// False when the amplitudes overflow; then there are no weights.
  [[nodiscard]] bool finite() const noexcept { return finite_; }
  /// Pairs of int16 modes, the weights of each, and what a product of 1 is worth.
  [[nodiscard]] std::span<const std::uint32_t> pairs16() const noexcept { return {pair16_.data(), count16_}; }
  [[nodiscard]] const WeightPair* weights16() const noexcept { return weight16_.data(); }
  [[nodiscard]] float unit16() const noexcept { return unit16_; }
  /// The same for quads of bytes; the sums begin with start8, as bytes count from 128.
  [[nodiscard]] std::span<const std::uint32_t> quads8() const noexcept { return {quad8_.data(), count8_}; }
  [[nodiscard]] const QuadWeights* weights8() const noexcept { return weight8_.data(); }
  [[nodiscard]] float unit8() const noexcept { return unit8_; }
  [[nodiscard]] std::int32_t start8() const noexcept { return start8_; }

  /// What the amounts of int16 weights may add up to: products of sixteen bits, 2^15 each at most, that fit 32 bits.
  static constexpr std::size_t kLargestSum = 65535;
  /// And those of bytes, byte[k] * pair[k / 2]: bytes differ from 128 by at most 2^7.
  static constexpr std::size_t kLargestByteSum = std::size_t{1} << 24U;

 private:
  void findSeen(std::span<const float> y, std::span<const float> peak,
                float unseen) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool seen(std::size_t group) const noexcept PALPATE_NONBLOCKING;
  void chooseInt16(std::span<const float> y, std::span<const float> scale) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] float findWeights(std::span<const float> y,
                                  std::span<const float> scale) noexcept PALPATE_NONBLOCKING;
  void chooseBytes(std::span<const float> y, std::span<const float> scale) noexcept PALPATE_NONBLOCKING;
  void findSlots(std::span<const float> y, std::span<const float> scale) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] float unitOfBytes() noexcept PALPATE_NONBLOCKING;
  void splitSlots() noexcept PALPATE_NONBLOCKING;
  void addQuad(std::size_t quad, std::size_t first) noexcept PALPATE_NONBLOCKING;

  ModeCounts counts_;
  std::vector<float> group_;  // amount of each pair, then of each quad of modes, over what may be left out
  int first_seen_{0};
  std::vector<std::int16_t> whole_;  // of int16 modes
  std::vector<float> slot_;          // amplitude of each byte
  std::vector<float> even_, odd_, left_;
  std::vector<std::int16_t> bytes_, weight_;
  std::vector<std::uint32_t> again_;
  std::vector<std::uint32_t> pair16_;
  std::vector<WeightPair> weight16_;
  std::vector<std::uint32_t> quad8_;
  std::vector<QuadWeights> weight8_;
  std::size_t count16_{0};
  std::size_t count8_{0};
  float unit16_{0.0F};
  float unit8_{0.0F};
  std::int32_t start8_{0};
  bool finite_{true};
};

}  // namespace palpate
