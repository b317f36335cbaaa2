// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/index.h"
#include "core/base/types.h"
#include "core/data/model_view.h"
#include "core/model/fields.h"
#include "core/surface/contact_patches.h"

namespace palpate {

/// Degree 1 of a "displacement" model's field: nodal Green's functions W_i, the displacement by a unit load at node i,
/// superposed over the patch. So it is as exact at any s as at a node.                    docs/design.md, Parts
///   u(X; s, f) = sum_i w_i(s) W_i(X) f,   W_i(X) = sum_k X_k(X) Z_i,k + N_i(X),   f = K_s d
/// Z the amplitudes of the modes, N the near field of node i. The middle of an edge that has no Green's function of its own
/// shares its load between the edge's ends. Borrows the model's arrays; built before the loop, then const.
class LinearField {
 public:
  explicit LinearField(const ModelView& view);

  /// Whether what the node carries is answered for.
  [[nodiscard]] bool carries(std::int32_t node) const noexcept { return sources_[index(node)][0] >= 0; }
  /// y += sum_i w_i Z_i f. @param y  [n]. Cost O(k n) for k nodes of the patch. Real-time: yes.
  void addAmplitudes(const PatchNodes& patch, const Vec3& f,
                     std::span<float> y) const noexcept PALPATE_NONBLOCKING;
  /// u += sum_i w_i N_i f. @param scratch  blockSize()  @param u  [Ns][3]. Real-time: yes.
  void addNear(const PatchNodes& patch, const Vec3& f, std::span<float> scratch,
               std::span<float> u) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] std::size_t blockSize() const noexcept { return near_.blockSize(); }
  /// What the near field of a unit load at a node moves other nodes by, weighted: sum_j w_j N_i(X_j) and the same for the
  /// other weights, column by load. @param weight  [Ns], four for each node, 0 for most. Real-time: yes.
  [[nodiscard]] std::array<Mat3, 4> nearBetween(
      std::int32_t node, std::span<const Eigen::Vector4f> weight) const noexcept PALPATE_NONBLOCKING;
  /// What the near field of these loads, patch weights times f, moves one node by, m. Cost O(k log K). Real-time: yes.
  [[nodiscard]] Vec3 nearAt(const PatchNodes& patch, const Vec3& f,
                            std::int32_t node) const noexcept PALPATE_NONBLOCKING;
  /// The farthest that a near field reaches from its node, m.
  [[nodiscard]] double reach() const noexcept { return reach_; }

 private:
  /// Calls with(Green's function, the share of a load at the node that is its).
  template <class With>
  void forEachSource(std::int32_t node, const With& with) const noexcept PALPATE_NONBLOCKING {
    const std::array<std::int32_t, 2>& sources = sources_[index(node)];
    const double share = sources[1] >= 0 ? 0.5 : 1.0;
    for (const std::int32_t source : sources)
      if (source >= 0) with(source, share);
  }

  std::vector<std::array<std::int32_t, 2>>
      sources_;            // [Ns] a node's Green's function, or those of an edge's ends, or -1
  Amplitudes amplitudes_;  // [G][3][n] Z, m/N
  NearField near_;         // [G], of 3 loads
  double reach_{0.0};
};

}  // namespace palpate
