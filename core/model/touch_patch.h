// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/types.h"
#include "core/model/meta_model.h"
#include "core/surface/contact_patches.h"

namespace palpate {

/// One contact patch as something that feels fields and makes them: its average over the modes and over nodes, and how these
/// change as it moves over the surface. Found once for each place of a tool.                docs/design.md, Symbols
///   P_s u = sum_j w_j(s) u_j
class TouchPatch {
 public:
  /// Four of what is averaged: with w_j, and with dw_j/dlambda.
  using Averages = std::array<Vec3, 4>;

  /// Allocates; before the loop.
  explicit TouchPatch(const MetaModel& model);

  /// Cost O(k n) for a patch of k nodes where s is another one. Real-time: yes.
  void moveTo(const MetaModel& model, const ContactPoint& s) noexcept PALPATE_NONBLOCKING;

  [[nodiscard]] const ContactPoint& s() const noexcept { return s_; }
  [[nodiscard]] const PatchNodes& nodes() const noexcept { return nodes_; }
  /// What answers for the nodes' loads, of a "displacement" model.
  [[nodiscard]] const PatchSources& sources() const noexcept { return sources_; }
  /// P_s of the modes sum_k X_k y_k, m. @param y  [n]. Cost O(n). Real-time: yes.
  [[nodiscard]] Averages ofModes(std::span<const float> y) const noexcept PALPATE_NONBLOCKING;
  /// sum_i w_i Z_i, [3 loads][n], m/N: the amplitudes that unit forces on this patch cause.
  [[nodiscard]] std::span<const float> load(std::size_t axis) const noexcept {
    return std::span(Z_).subspan(axis * modes_, modes_);
  }

 private:
  ContactPoint s_;
  PatchNodes nodes_;
  PatchSources sources_;
  std::size_t modes_;
  std::vector<float> X_;  // [4][3][n]
  std::vector<float> Z_;  // [3][n]
};

}  // namespace palpate
