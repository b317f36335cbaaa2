// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/types.h"
#include "core/data/model_view.h"
#include "core/surface/surface_mesh.h"

namespace palpate {

/// The surface that tools slide on: the rest surface, rounded.                        docs/design.md, Contact
/// A tip on flat triangles is pushed along the interpolated normal while it moves along the triangle: the two are not
/// normal to each other, so the contact creates energy. Therefore each triangle is divided into 4, a few times; the new
/// node on an edge a-b is the middle of the cubic that has the edge's ends and, there, its direction laid into the
/// planes normal to n_a and n_b:  (a + b) / 2 + (P_a - P_b) (b - a) / 8  (on a curve the 4-point scheme of
/// N. Dyn, D. Levin, J. Gregory, Comput. Aided Geom. Des. 4 (1987) 257-268). The mesh's own nodes stay.
/// Points of the two surfaces correspond: triangle t is divided into 4^levels, from 4^levels t on.
/// Built before the loop, then const.
class ContactSurface {
 public:
  /// As many levels, at most 4, as give no more than `most` triangles, but one at any size; and as give none without an
  /// area (a blade's edge may fold up): 0 is the rest surface itself.
  ContactSurface(const ModelView& view, const SurfaceMesh& rest, std::size_t most);

  /// The rounded surface; its contact points are "fine" ones.
  [[nodiscard]] const SurfaceMesh& mesh() const noexcept { return *mesh_; }
  [[nodiscard]] int levels() const noexcept { return levels_; }
  /// Farthest that any of its points lies from its point of the rest surface, m.
  [[nodiscard]] double bulge() const noexcept { return bulge_; }
  /// The point of the rest surface that belongs to a fine one. Real-time: yes.
  [[nodiscard]] ContactPoint rest(const ContactPoint& fine) const noexcept PALPATE_NONBLOCKING;
  /// SurfaceMesh::frame() of a fine point, but continuous over edges: `turning` and `rates` are the triangles' averaged at
  /// their nodes and mixed barycentrically, `rates` those of the rest point's weights.
  /// @param rest  the surface that this one was made from. Real-time: yes.
  [[nodiscard]] TangentFrame frame(const SurfaceMesh& rest,
                                   const ContactPoint& fine) const noexcept PALPATE_NONBLOCKING;
  /// Asks the cache for what frame() reads of a fine triangle. Real-time: yes.
  void expect(std::int32_t triangle) const noexcept PALPATE_NONBLOCKING;
  /// The fine point that belongs to one of the rest surface. Real-time: yes.
  [[nodiscard]] ContactPoint fine(const ContactPoint& rest) const noexcept PALPATE_NONBLOCKING;

 private:
  /// What changes along the surface, at a node.
  struct Slope {
    Eigen::Matrix3f normal = Eigen::Matrix3f::Zero();  // dn/dX, 1/m
    Eigen::Matrix3f rest = Eigen::Matrix3f::Zero();    // d(rest point)/dX
  };
  void findSlopes(std::span<const Vec3> rest_points);

  std::vector<double> positions_;        // [N][3], m
  std::vector<std::int32_t> triangles_;  // [T 4^levels][3]
  int levels_{0};
  double bulge_{0.0};                  // m
  std::unique_ptr<SurfaceMesh> mesh_;  // borrows the first two
  std::vector<Slope> slopes_;          // [N]
};

}  // namespace palpate
