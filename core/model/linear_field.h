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
#include "core/model/node_sum.h"
#include "core/surface/contact_patches.h"

namespace palpate {

/// The Green's functions that answer for a patch, the first `count` of each. Its memory is made once, so that they can be found
/// in a tick.
struct PatchSources {
  std::size_t count{0};
  std::vector<std::int32_t> source;  ///< Green's functions, each once
  std::vector<double> weight;        ///< the part of the patch's load that each answers for
  std::vector<std::int32_t>
      place;  ///< [G] of a Green's function, by which it is found again; -1 between uses
};

/// Near fields of unit loads on a patch, added up: by node a matrix, column by load. Its memory is made once.
struct UnitNear {
  /// What they move a node by, m/N. Real-time: yes.
  [[nodiscard]] Mat3 at(std::int32_t node) const noexcept PALPATE_NONBLOCKING {
    return sum.matrixAt(node).cast<double>();
  }

  NodeSum sum;                       ///< m/N
  std::size_t count{0};              ///< of the Green's functions whose nodes it reaches, the first of
  std::vector<std::int32_t> source;  ///< with room for those of any patch
};

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
  /// Whether any node's load is shared, so that a patch may have two sources for a node.
  [[nodiscard]] bool sharesLoads() const noexcept { return shares_loads_; }
  /// The sources of a patch's loads. @param[out] out  made by room(). Cost O(k) for k nodes of the patch. Real-time: yes.
  void find(const PatchNodes& patch, PatchSources& out) const noexcept PALPATE_NONBLOCKING;
  /// Sources with room for those of any patch. @param nodes  that a patch has, at most. Not real-time.
  [[nodiscard]] PatchSources room(std::size_t nodes) const;
  /// y += sum_i w_i Z_i f. @param y  [n]. Cost O(k n) for k sources. Real-time: yes.
  void addAmplitudes(const PatchSources& from, const Vec3& f,
                     std::span<float> y) const noexcept PALPATE_NONBLOCKING;
  /// Of unit loads: y += sum_i w_i Z_i. @param y  [3 loads][n]. Cost O(k n). Real-time: yes.
  void addUnitAmplitudes(const PatchSources& from, std::span<float> y) const noexcept PALPATE_NONBLOCKING;
  /// u += sum_i w_i N_i f. @param unit  overwritten  @param u  [Ns][3]. Cost O(k K). Real-time: yes.
  void addNear(const PatchSources& from, const Vec3& f, UnitNear& unit,
               std::span<float> u) const noexcept PALPATE_NONBLOCKING;
  /// Of unit loads: sum_i w_i N_i. Cost O(k K). Real-time: yes.
  void findUnitNear(const PatchSources& from, UnitNear& unit) const noexcept PALPATE_NONBLOCKING;
  /// Room for those of any patch. @param nodes  of the surface  @param sources  room()'s. Not real-time.
  [[nodiscard]] static UnitNear unitNear(std::size_t nodes, const PatchSources& sources);
  /// What the near fields of unit loads on a patch move one node by, column by load, m/N. Cost O(k log K). Real-time: yes.
  [[nodiscard]] Mat3 nearAt(const PatchSources& from, std::int32_t node) const noexcept PALPATE_NONBLOCKING;
  /// The farthest that a near field reaches from its node, m.
  [[nodiscard]] double reach() const noexcept { return reach_; }

 private:
  std::vector<std::array<std::int32_t, 2>>
      sources_;                        // [Ns] a node's Green's function, or those of an edge's ends, or -1
  std::size_t greens_;                 // G
  Amplitudes amplitudes_;              // [G][3][n] Z, m/N
  NearNodes nodes_;                    // [G]
  WholeNumbers near_;                  // [sum K][3 loads][3]
  std::span<const float> near_scale_;  // [G][3]
  double reach_{0.0};
  bool shares_loads_{false};
};

}  // namespace palpate
