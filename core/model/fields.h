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

/// The far field, and all of a load-driven model's:                       docs/design.md, Reproduction, Parts
///   u(X; s, p) = sum_k X_k(X) y_k,   y_k = sum_b lambda_b sum_alpha phi_alpha(p) Y_{k,alpha}(p_b)
/// Linear in y: the y of several tools add up before the one product with X. Borrows the model's arrays.
class SeparatedField {
 public:
  explicit SeparatedField(const ModelView& view);

  [[nodiscard]] int modes() const noexcept { return modes_; }
  /// y += gain * (the mode amplitudes of one tool), m.
  /// @param phi  [C] ParameterFunctions at p, @param y  [n]. Cost O(C n). Real-time: yes.
  void addAmplitudes(const PositionMix& mix, std::span<const double> phi, double gain,
                     std::span<float> y) const noexcept PALPATE_NONBLOCKING;
  /// u = X^T y, m. @param u  [Ns][3]. Cost O(n Ns). Real-time: yes.
  void expand(std::span<const float> y, std::span<float> u) const noexcept PALPATE_NONBLOCKING;
  /// u of one surface node, m, as expand() gives it but for rounding. Cost O(n). Real-time: yes.
  [[nodiscard]] Vec3 at(std::span<const float> y, int node) const noexcept PALPATE_NONBLOCKING;

 private:
  std::span<const std::int16_t> X_, Y_;
  std::span<const float> X_scale_, Y_scale_;
  int modes_;
  std::vector<float> by_node_;  // [Ns][3][n] X, so that one node's numbers lie together
};

/// The near field: what the modes miss close to s, already windowed to zero at the near radius (docs/design.md, Parts).
class NearField {
 public:
  explicit NearField(const ModelView& view);

  /// The near block of one contact position; borrowed from the model and the scratch.
  struct Block {
    std::span<const std::int32_t> nodes;  ///< [K_m] surface nodes
    std::span<const float> u;             ///< [K_m][3] m
  };

  /// Surface nodes that a position's block moves. Real-time: yes.
  [[nodiscard]] std::span<const std::int32_t> nodes(std::int32_t position) const noexcept PALPATE_NONBLOCKING;
  /// Numbers of scratch: 3 * the largest K_m for a block, then Ns for weights of its nodes.
  [[nodiscard]] int scratchSize() const noexcept { return scratch_size_; }
  /// sum_alpha phi_alpha U_alpha of one position times `factor`. @param phi  [C] ParameterFunctions at p
  /// @param scratch  scratchSize(), its beginning overwritten. Real-time: yes.
  [[nodiscard]] Block block(std::int32_t position, std::span<const double> phi, double factor,
                            std::span<float> scratch) const noexcept PALPATE_NONBLOCKING;
  /// What block() gives at one node, m; zero where the block has it not. Cost O(C + K_m). Real-time: yes.
  [[nodiscard]] Vec3 at(std::int32_t position, std::span<const double> phi,
                        std::int32_t node) const noexcept PALPATE_NONBLOCKING;
  /// u += gain * (the near blocks of one tool), m.
  /// @param phi  [C] ParameterFunctions at p, @param scratch  scratchSize(), @param u  [Ns][3]. Real-time: yes.
  void add(const PositionMix& mix, std::span<const double> phi, double gain, std::span<float> scratch,
           std::span<float> u) const noexcept PALPATE_NONBLOCKING;

 private:
  std::span<const std::int64_t> offset_;
  std::span<const std::int32_t> node_;
  std::span<const std::int16_t> field_;
  std::span<const float> scale_;
  int scratch_size_{0};
};

}  // namespace palpate
