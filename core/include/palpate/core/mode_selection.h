// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/core/packed_modes.h"
#include "palpate/core/types.h"

namespace palpate {

/// Whole-number weights of two modes, as they are multiplied by one instruction.
using WeightPair = std::array<std::int16_t, 2>;

/// Weights of four int8 modes a, b, c, d.
struct QuadWeights {
  WeightPair bd;
  WeightPair ac;
};

/// Which packed modes a field needs at its amplitudes y, and with what weights: whole numbers, whose amounts add up to
/// at most kLargestSum for each kind of modes, so that a sum of products fits 32 bits. Scratch of one thread, allocated
/// before the loop.
class ModeSelection {
 public:
  explicit ModeSelection(const ModeCounts& counts);

  /// Leaves out modes that cannot be seen: those with the smallest |y_k| peak_k, as many as have a sum of at most
  /// `unseen`, found by half octaves. That sum bounds what leaving them out costs at any node.
  /// @param y  [n] m  @param peak  [n] largest displacement of a node in each mode  @param packed  the modes
  /// @param unseen  m; 0 leaves out nothing  Cost O(n). Real-time: yes.
  void choose(std::span<const float> y, std::span<const float> peak, const PackedModes& packed,
              float unseen) noexcept PALPATE_NONBLOCKING;

  /// False when the amplitudes are too large for numbers; then there are no weights.
  [[nodiscard]] bool finite() const noexcept { return finite_; }
  /// Pairs of int16 modes, the weights of each, and what a product of 1 is worth.
  [[nodiscard]] std::span<const std::uint32_t> pairs16() const noexcept { return {pair16_.data(), count16_}; }
  [[nodiscard]] const WeightPair* weights16() const noexcept { return weight16_.data(); }
  [[nodiscard]] float unit16() const noexcept { return unit16_; }
  /// Quads of int8 modes likewise; a number of a mode counts 256 times.
  [[nodiscard]] std::span<const std::uint32_t> quads8() const noexcept { return {quad8_.data(), count8_}; }
  [[nodiscard]] const QuadWeights* weights8() const noexcept { return weight8_.data(); }
  [[nodiscard]] float unit8() const noexcept { return unit8_; }

  /// Products of sixteen bits, 2^15 each at most, that fit 32 bits.
  static constexpr std::size_t kLargestSum = 65535;
  /// Of one kind. Weights are made to add up to kLargestSum - n and rounded by up to a half each, so that any n keeps
  /// the sum; but with more modes than this rounding would take more than an eighth of it.
  static constexpr std::size_t kMostModes = 16384;

 private:
  [[nodiscard]] int firstSeen(float per_tolerance) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] float findWeights(std::span<const float> y, std::span<const float> scale,
                                  std::span<std::int16_t> weight) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool anySeen(std::size_t first, std::size_t count) const noexcept PALPATE_NONBLOCKING;

  ModeCounts counts_;
  std::vector<float> amount_;
  float per_tolerance_{0.0F};
  int first_seen_{0};
  std::vector<std::int16_t> whole_;  // of one kind of modes
  std::vector<std::uint32_t> pair16_;
  std::vector<WeightPair> weight16_;
  std::vector<std::uint32_t> quad8_;
  std::vector<QuadWeights> weight8_;
  std::size_t count16_{0};
  std::size_t count8_{0};
  float unit16_{0.0F};
  float unit8_{0.0F};
  bool finite_{true};
};

}  // namespace palpate
