// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "tools/solver/fem/integration_point.h"
#include "tools/solver/fem/material.h"

namespace palpate::solver {

/// Tetrahedra of four nodes, or with those in the middle of their edges of ten.
struct Tetrahedra {
  std::vector<std::array<std::int32_t, 4>> corners;     ///< 0-based, positive volume
  std::vector<std::array<std::int32_t, 6>> midsides{};  ///< of mesh::kTetEdges; empty: linear elements
};

/// Ties a node to where it rests, alike in every direction.
struct Spring {
  std::int32_t node;
  double stiffness;  ///< N/m, > 0
};

/// A body of tetrahedra, linear or quadratic, clamped at some nodes and held by springs at others: the discrete problem
/// that every solver here works on.
/// Nodal vectors u, f have 3 N entries, node-interleaved; the unknowns ("dofs") are those of the free nodes.
class FeModel {
 public:
  static constexpr int kMostNodes = 10;  ///< of an element
  /// Integration points of elements of four or of ten nodes, element by element.
  using Points = std::variant<std::vector<IntegrationPoint<4>>, std::vector<IntegrationPoint<10>>>;
  using ElementMatrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * kMostNodes, 3 * kMostNodes>;

  /// @param nodes  rest positions X, m  @param fixed  clamped nodes
  /// @throw std::invalid_argument naming the element or node that is degenerate or out of range, or the number
  /// that the law cannot take
  FeModel(std::vector<Vec3> nodes, Tetrahedra tetrahedra, std::vector<std::int32_t> fixed, Material material,
          std::vector<Spring> springs = {});

  [[nodiscard]] int nodeCount() const noexcept { return static_cast<int>(nodes_.size()); }
  [[nodiscard]] int elementCount() const noexcept { return static_cast<int>(tetrahedra_.corners.size()); }
  [[nodiscard]] int dofCount() const noexcept { return dof_count_; }
  [[nodiscard]] const std::vector<Vec3>& nodes() const noexcept { return nodes_; }
  [[nodiscard]] const Tetrahedra& tetrahedra() const noexcept { return tetrahedra_; }
  [[nodiscard]] bool isQuadratic() const noexcept { return !tetrahedra_.midsides.empty(); }
  [[nodiscard]] const std::vector<std::int32_t>& fixedNodes() const noexcept { return fixed_; }
  [[nodiscard]] const Material& material() const noexcept { return material_; }
  [[nodiscard]] const std::vector<Spring>& springs() const noexcept { return springs_; }
  /// Of each element one, or four of a quadratic one.
  [[nodiscard]] const Points& points() const noexcept { return points_; }
  /// Where det F is looked at: the integration points; of quadratic elements, in which it is cubic, the nodes too.
  [[nodiscard]] const Points& detPoints() const noexcept { return det_points_ ? *det_points_ : points_; }
  /// The nodes that have a part in an element, corners first.
  [[nodiscard]] std::span<const std::int32_t> elementNodes(int element) const noexcept;
  [[nodiscard]] double volume(int element) const noexcept;
  /// First unknown of a node (its x; y and z follow), -1 for a clamped node.
  [[nodiscard]] int dof(int node) const noexcept { return dofs_[index(node)]; }
  [[nodiscard]] bool isFree(int node) const noexcept { return dof(node) >= 0; }

  /// Nodal forces f_int = int P(u) : grad delta and those of the springs, 3 N, N.   docs/design.md, Series
  [[nodiscard]] Eigen::VectorXd internalForce(const Eigen::VectorXd& u) const;
  /// Elastic energy int Psi(u), with the springs', J.
  [[nodiscard]] double energy(const Eigen::VectorXd& u) const;
  /// Consistent tangent of one element in the order of elementNodes(), node-interleaved, N/m. The first element of a node
  /// has its spring, so the sum over elements is the tangent of internalForce().
  [[nodiscard]] ElementMatrix elementTangent(int element, const Eigen::VectorXd& u) const;
  /// Smallest det F over detPoints(): at most 0 where an element is inside out.
  [[nodiscard]] double minDetF(const Eigen::VectorXd& u) const;

 private:
  /// Where an element's tangent holds a spring.
  struct ElementSpring {
    int element;
    int node;  // within the element
    double stiffness;
  };

  static std::size_t index(int i) noexcept { return static_cast<std::size_t>(i); }
  void findElementsOfSprings();

  std::vector<Vec3> nodes_;
  Tetrahedra tetrahedra_;
  std::vector<std::int32_t> fixed_;
  Material material_;
  std::vector<Spring> springs_;
  std::vector<ElementSpring> element_springs_;  // by element
  Points points_;
  std::optional<Points> det_points_;  // of quadratic elements
  std::vector<int> dofs_;
  int dof_count_{0};
};

}  // namespace palpate::solver
