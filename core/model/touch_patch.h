// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/kernels.h"
#include "core/base/types.h"
#include "core/model/meta_model.h"
#include "core/model/node_sum.h"
#include "core/surface/contact_patches.h"

namespace palpate {

/// One contact patch as something that feels fields and makes them: its average over the modes and over nodes, and how these
/// change as it moves over the surface; what unit forces on it do. Found once for each place of a tool. docs/design.md, Symbols
///   P_s u = sum_j w_j(s) u_j
class TouchPatch {
 public:
  /// What is averaged with w_j, and with dw_j/dlambda.
  static constexpr std::size_t kWeights = 4;
  static_assert(kWeights == kTogether);

  /// Allocates; before the loop.
  explicit TouchPatch(const MetaModel& model);

  /// Cost O(k n) for a patch of k nodes where s is another one. Real-time: yes.
  void moveTo(const MetaModel& model, const ContactPoint& s) noexcept PALPATE_NONBLOCKING;
  /// near(), of a "displacement" model; where it is known there is nothing to do. Cost O(k K). Real-time: yes.
  void findNear(const MetaModel& model) noexcept PALPATE_NONBLOCKING;

  [[nodiscard]] const ContactPoint& s() const noexcept { return s_; }
  [[nodiscard]] const PatchNodes& nodes() const noexcept { return nodes_; }
  /// X_k averaged, [kWeights][3][n].
  [[nodiscard]] const float* modes() const noexcept { return X_.data(); }
  /// The nodes' numbers averaged. @param[out] out  [kWeights][kNodeFloats]. Cost O(k). Real-time: yes.
  void average(const NodeSum& u, float* out) const noexcept PALPATE_NONBLOCKING;
  /// sum_i w_i Z_i, [n], m/N: the amplitudes that a unit force on this patch causes, along x, y or z.
  [[nodiscard]] std::span<const float> load(std::size_t axis) const noexcept {
    return std::span(Z_).subspan(axis * modes_, modes_);
  }
  /// sum_i w_i N_i, m/N: what these forces cause near it, a matrix for each node. After findNear().
  [[nodiscard]] const UnitNear& near() const noexcept { return near_; }

 private:
  ContactPoint s_;
  PatchNodes nodes_;
  std::vector<float> weight_;  // [k][kWeights]
  PatchSources sources_;
  std::size_t modes_;
  std::vector<float> X_;  // [kWeights][3][n]
  std::vector<float> Z_;  // [3][n]
  UnitNear near_;
  bool near_found_{false};
};

}  // namespace palpate
