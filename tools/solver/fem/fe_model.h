// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/solver/fem/integration_point.h"
#include "tools/solver/fem/material.h"

namespace palpate::solver {

/// A body of linear tetrahedra, clamped at some nodes: the discrete problem that every solver here works on.
/// Nodal vectors u, f have 3 N entries, node-interleaved; the unknowns ("dofs") are those of the free nodes.
class FeModel {
 public:
  static constexpr int kNodes = 4;           ///< of an element
  static constexpr std::size_t kPoints = 1;  ///< of an element
  using Point = IntegrationPoint<kNodes>;
  using ElementMatrix = Eigen::Matrix<double, 3 * kNodes, 3 * kNodes>;

  /// @param nodes  rest positions X, m  @param tetrahedra  0-based, positive volume  @param fixed  clamped
  /// nodes
  /// @throw std::invalid_argument naming the element or node that is degenerate or out of range, or the number
  /// that the law cannot take
  FeModel(std::vector<Vec3> nodes, std::vector<std::array<std::int32_t, 4>> tetrahedra,
          std::vector<std::int32_t> fixed, Material material);

  [[nodiscard]] int nodeCount() const noexcept { return static_cast<int>(nodes_.size()); }
  [[nodiscard]] int elementCount() const noexcept { return static_cast<int>(tetrahedra_.size()); }
  [[nodiscard]] int dofCount() const noexcept { return dof_count_; }
  [[nodiscard]] const std::vector<Vec3>& nodes() const noexcept { return nodes_; }
  [[nodiscard]] const std::vector<std::array<std::int32_t, 4>>& tetrahedra() const noexcept {
    return tetrahedra_;
  }
  [[nodiscard]] const std::vector<std::int32_t>& fixedNodes() const noexcept { return fixed_; }
  [[nodiscard]] const Material& material() const noexcept { return material_; }
  /// kPoints of each element, element by element.
  [[nodiscard]] std::span<const Point> points() const noexcept { return points_; }
  /// The nodes that have a part in an element.
  [[nodiscard]] std::span<const std::int32_t> elementNodes(int element) const noexcept {
    return points_[index(element) * kPoints].nodes;
  }
  [[nodiscard]] double volume(int element) const noexcept;
  /// First unknown of a node (its x; y and z follow), -1 for a clamped node.
  [[nodiscard]] int dof(int node) const noexcept { return dofs_[index(node)]; }
  [[nodiscard]] bool isFree(int node) const noexcept { return dof(node) >= 0; }

  /// Nodal forces f_int = int P(u) : grad delta, 3 N, N.                          docs/design.md, Series
  [[nodiscard]] Eigen::VectorXd internalForce(const Eigen::VectorXd& u) const;
  /// Elastic energy int Psi(u), J.
  [[nodiscard]] double energy(const Eigen::VectorXd& u) const;
  /// Consistent tangent of one element in the order of elementNodes(), node-interleaved, N/m.
  [[nodiscard]] ElementMatrix elementTangent(int element, const Eigen::VectorXd& u) const;
  /// Smallest det F over the integration points: at most 0 where an element is inside out.
  [[nodiscard]] double minDetF(const Eigen::VectorXd& u) const;

 private:
  static std::size_t index(int i) noexcept { return static_cast<std::size_t>(i); }
  [[nodiscard]] std::span<const Point> pointsOf(int element) const noexcept {
    return points().subspan(index(element) * kPoints, kPoints);
  }

  std::vector<Vec3> nodes_;
  std::vector<std::array<std::int32_t, 4>> tetrahedra_;
  std::vector<std::int32_t> fixed_;
  Material material_;
  std::vector<Point> points_;
  std::vector<int> dofs_;
  int dof_count_{0};
};

}  // namespace palpate::solver
