// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/base/contact_point.h"
#include "core/surface/contact_patches.h"
#include "core/surface/surface_distance.h"
#include "tools/solver/fem/fe_model.h"

namespace palpate::solver {

/// The surface that a tool may touch, in surface-node numbering, with the graph and areas that define
/// patches.
struct PatchSurface {
  std::vector<std::int32_t> nodes;                     ///< Ns volume nodes, in any order
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< T x 3 into nodes, flat, outward
  std::vector<std::array<std::int32_t, 3>>
      faces;                    ///< corners of the elements' faces; points s are points of these
  std::vector<Vec3> positions;  ///< Ns, m
  SurfaceGraph graph;           ///< of the same surface, for distances along it
  std::vector<double> areas;    ///< Ns lumped rest areas, m^2

  /// @param element_faces  the triangles, or one for each four of them; empty: the triangles. docs/design.md, Elements
  PatchSurface(const FeModel& model, std::vector<std::int32_t> surface_nodes,
               std::vector<std::array<std::int32_t, 3>> surface_triangles,
               std::vector<std::array<std::int32_t, 3>> element_faces = {});

  [[nodiscard]] Vec3 position(const ContactPoint& s) const;
  /// The point that is surface node i.
  [[nodiscard]] ContactPoint atNode(int node) const { return graph.atNode(node); }
  /// [Ns] whether the node is a corner of a face, and not in the middle of an edge.
  [[nodiscard]] std::vector<bool> corners() const;
  /// Median edge length of the faces, m.
  [[nodiscard]] double medianEdge() const;
};

/// The contact patch G_s of docs/design.md, Symbols: G_s f = nodal forces w_i f, G_s^T u = sum w_i u_i.
struct Patch {
  std::vector<std::int32_t> nodes;  ///< volume nodes, free ones only
  std::vector<double> weights;      ///< w_i, sum 1
  double free_share{0.0};           ///< weight on free nodes before renormalization, in [0, 1]

  void addForce(const Vec3& f, Eigen::VectorXd& nodal) const {
    for (std::size_t i = 0; i < nodes.size(); ++i) nodal.segment<3>(3 * nodes[i]) += weights[i] * f;
  }
  [[nodiscard]] Vec3 average(const Eigen::VectorXd& u) const {
    Vec3 d = Vec3::Zero();
    for (std::size_t i = 0; i < nodes.size(); ++i) d += weights[i] * u.segment<3>(3 * nodes[i]);
    return d;
  }
};

/// [Ns] 1: the node may carry load.
[[nodiscard]] std::vector<std::uint8_t> freeNodes(const FeModel& model, const PatchSurface& surface);

/// A patch of surface nodes as one of volume nodes.
[[nodiscard]] Patch patchOf(const PatchSurface& surface, const PatchNodes& nodes);

/// The patch at s, as the server finds it (core's ContactPatches). A patch without a free node is empty and has
/// free_share 0. For many patches of a surface, make its ContactPatches once.       docs/design.md, Symbols
[[nodiscard]] Patch makePatch(const FeModel& model, const PatchSurface& surface, const ContactPoint& s,
                              double a);

}  // namespace palpate::solver
