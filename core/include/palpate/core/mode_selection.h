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

/// Whole-number weights of four int8 modes a, b, c, d: b and d apart from a and c, as they are multiplied.
struct QuadWeights {
  std::array<std::int16_t, 2> bd;
  std::array<std::int16_t, 2> ac;
};

/// Which packed modes a field needs at its amplitudes y, and with what weights. Scratch of one thread, allocated
/// before the loop.
class ModeSelection {
 public:
  explicit ModeSelection(const ModeCounts& counts);

  /// Leaves out modes that cannot be seen: those with the smallest |y_k| peak_k, as many as have a sum of at most
  /// `unseen`, found by half octaves. That sum bounds what leaving them out costs at any node.
  /// @param y  [n] m  @param peak  [n] largest displacement of a node in each mode  @param scale  PackedModes::scale
  /// @param unseen  m; 0 leaves out nothing  Cost O(n). Real-time: yes.
  void choose(std::span<const float> y, std::span<const float> peak, std::span<const float> scale,
              float unseen) noexcept PALPATE_NONBLOCKING;

  /// False when the amplitudes are too large for numbers; then there is no int8 weight.
  [[nodiscard]] bool finite() const noexcept { return finite_; }
  /// Rows of float16 modes, and what each is multiplied by.
  [[nodiscard]] std::span<const std::uint32_t> rows16() const noexcept { return {row16_.data(), count16_}; }
  [[nodiscard]] const float* weights16() const noexcept { return weight16_.data(); }
  /// Quads of int8 modes, their weights and what one of those is worth. All weights' amounts add up to at most
  /// kLargestSum, so that a sum of products fits 32 bits.
  [[nodiscard]] std::span<const std::uint32_t> quads8() const noexcept { return {quad8_.data(), count8_}; }
  [[nodiscard]] const QuadWeights* weights8() const noexcept { return weight8_.data(); }
  [[nodiscard]] float unit8() const noexcept { return unit8_; }

  /// Products of sixteen bits, 2^15 each at most, that fit 32 bits.
  static constexpr std::size_t kLargestSum = 65535;
  /// Each weight is rounded by up to a half: with more int8 modes the sum could be exceeded.
  static constexpr std::size_t kMostInt8 = 16384;

 private:
  [[nodiscard]] int firstSeen(float per_tolerance) const noexcept;
  template <typename Seen>
  void chooseQuads(std::span<const float> y, std::span<const float> scale, const Seen& seen) noexcept;

  ModeCounts counts_;
  std::vector<float> amount_;
  std::vector<std::uint32_t> row16_;
  std::vector<float> weight16_;
  std::vector<std::uint32_t> quad8_;
  std::vector<QuadWeights> weight8_;
  std::size_t count16_{0};
  std::size_t count8_{0};
  float unit8_{0.0F};
  bool finite_{true};
};

}  // namespace palpate
