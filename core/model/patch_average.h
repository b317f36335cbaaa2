// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/types.h"
#include "core/data/model_view.h"

namespace palpate {

/// What of a surface field a contact patch feels: its average with the patch weights w_i(s).   docs/design.md, Symbols
///   P_s u = sum_i w_i(s) u_i,   w_i(p) ~ A_i exp(-r_i^2 / 2 a^2) for r_i < 3 a, free nodes only, sum 1
/// at each contact position p, mixed barycentrically between them like every other answer. The same patch that
/// the solver imposes d on. Built at load: the patches, and the modes averaged over each.
class PatchAverage {
 public:
  static constexpr std::size_t kMostNodes = 2048;             ///< of a patch: 25 edges from its centre
  static constexpr std::size_t kMostTogether = 64ULL << 20U;  ///< of all patches: half a GiB

  /// Borrows nothing of `view` afterwards. O(M k (log k + n)) for patches of k nodes; not real-time.
  /// @throw std::invalid_argument when patch_radius is so large that a patch has more than kMostNodes, or
  /// all have more than kMostTogether, those that are fixed included
  PatchAverage(const ModelView& view, const ModelAttributes& attributes);

  /// Nodes of a position's patch, nearest first, none when all are fixed.
  [[nodiscard]] std::span<const std::int32_t> nodes(std::int32_t position) const noexcept PALPATE_NONBLOCKING;
  /// Their weights, sum 1.
  [[nodiscard]] std::span<const float> weights(std::int32_t position) const noexcept PALPATE_NONBLOCKING;
  /// Memory that the patches and averaged modes take, bytes.
  [[nodiscard]] std::size_t bytes() const noexcept;

  /// P_s of the far field sum_k X_k y_k, m. @param y  [n]. Cost O(n). Real-time: yes.
  [[nodiscard]] Vec3 ofModes(const PositionMix& at,
                             std::span<const float> y) const noexcept PALPATE_NONBLOCKING;
  /// Adds the weights w_i(s) to table[i]. @param table  [Ns]. Real-time: yes.
  void addWeights(const PositionMix& at, std::span<float> table) const noexcept PALPATE_NONBLOCKING;
  /// False when the near field of position `from` ends before the patch of any position of `at`.
  [[nodiscard]] bool meets(std::int32_t from, const PositionMix& at) const noexcept PALPATE_NONBLOCKING;

 private:
  void findPatches(const ModelView& view, double a);
  void averageModes(const ModelView& view);
  void measureReach(const ModelView& view);

  std::size_t modes_;
  std::vector<std::size_t> first_;   ///< [M + 1] into node_ and weight_
  std::vector<std::int32_t> node_;   ///< [sum k]
  std::vector<float> weight_;        ///< [sum k]
  std::vector<float> averaged_;      ///< [M][3][n] P_p X_k
  std::vector<Vec3> centre_;         ///< [M] X(p), m
  std::vector<double> patch_reach_;  ///< [M] largest |X_i - X(p)| over the patch, m
  std::vector<double> near_reach_;   ///< [M] the same over the near field
};

}  // namespace palpate
