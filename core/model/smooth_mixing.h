// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/types.h"
#include "core/data/model_view.h"
#include "core/surface/surface_mesh.h"

namespace palpate {

/// Which contact positions answer at s, how much each, and how that changes as s moves.
struct Stencil {
  static constexpr std::size_t kMost = 48;
  std::size_t count{0};                      ///< 0: no answer at s
  std::array<std::int32_t, kMost> position;  // the first `count` of each
  std::array<double, kMost> weight;          ///< omega_b(s), sum 1; some are a little below 0
  std::array<Vec3, kMost> slope;             ///< d omega_b / d lambda, the triangle's barycentric weights, 1
};

/// The positions and weights of a linear mix; without slopes. Real-time: yes.
[[nodiscard]] Stencil linearStencil(const PositionMix& mix) noexcept PALPATE_NONBLOCKING;

/// Interpolation between contact positions, smooth enough to feel no kinks.             docs/design.md, Parts
///   c(s) = sum_b omega_b(s) c_b:  over each triangle the cubic that has the nodes' values and gradients, the gradient
///   at a node being the mean, by area, of those of the linear interpolation in the triangles round it. The Bezier
///   form and its middle coefficient are those of A. Vlachos, J. Peters, C. Boyd, J. Mitchell, Curved PN triangles,
///   I3D 2001, for a scalar.
/// So force f = sum omega_b f_b and the force on the anchor, dW/ds = sum d omega_b/ds W_b, are derivatives of one energy
/// W(s, d) = sum omega_b W_b: no path of a tool gains energy.
/// Where a node has no contact position, the linear mix of SurfaceMesh::mix() stays.
/// Borrows the model's arrays; built before the loop, then const.
class SmoothMixing {
 public:
  SmoothMixing(const ModelView& view, const SurfaceMesh& surface);
  /// @param surface  as in the constructor. Cost some 20 positions. Real-time: yes.
  [[nodiscard]] Stencil at(const SurfaceMesh& surface,
                           const ContactPoint& s) const noexcept PALPATE_NONBLOCKING;
  /// Asks the cache for what at() reads in a triangle. @return the positions that answer there. Real-time: yes.
  std::span<const std::int32_t> expect(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING;

 private:
  struct Part {
    std::int32_t position;  // whose value,
    Vec3 gradient;          // times this, 1/m
  };
  /// What a position gets of the gradient G at a triangle's corner: its part of G along the edges to the next corner
  /// and the one after.
  struct Share {
    double one, other;
    std::uint8_t corner, of;  // of which of the triangle's positions
  };
  /// Where a triangle's positions and shares begin.
  struct First {
    std::size_t position, share;
  };
  void addTriangle(const ModelView& view, std::size_t triangle, std::vector<std::vector<Part>>& parts,
                   std::vector<double>& area) const;
  void addStencil(const SurfaceMesh& surface, std::int32_t triangle,
                  const std::vector<std::vector<Part>>& parts);

  std::span<const std::int32_t> triangles_;
  std::span<const std::int32_t> position_of_node_;
  std::vector<First> first_;             // [T + 1]
  std::vector<std::int32_t> positions_;  // of each triangle, its nodes' first; none where it is not complete
  std::vector<Share> shares_;
};

}  // namespace palpate
