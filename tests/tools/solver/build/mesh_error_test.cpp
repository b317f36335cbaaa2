// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/mesh_error.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numeric>

#include "tools/mesh/box_mesh.h"
#include "tools/mesh/eighths.h"
#include "tools/mesh/quadratic.h"

namespace palpate::solver {
namespace {

mesh::TetMesh heldBelow(mesh::TetMesh box) {
  box.groups.clear();
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(box.nodes.size()); ++node)
    if (box.nodes[static_cast<std::size_t>(node)].z() < 1e-9) box.groups["fixed"].push_back(node);
  return box;
}

Case caseOf(double nu, double patch_radius = 0.012) {
  Case c;
  c.mesh = "block";
  c.nu = nu;
  c.patch_radius = patch_radius;
  return c;
}

MeshError errorOf(const mesh::TetMesh& mesh, double nu) {
  const SolverSetup setup(caseOf(nu, 0.015), mesh);
  Cholesky factor(setup.model);
  factor.factorize(Eigen::VectorXd::Zero(3 * setup.model.nodeCount()));
  return meshError(setup, mesh, factor, 2);
}

class LockingBlock : public ::testing::Test {
 protected:
  const mesh::TetMesh coarse_ = heldBelow(mesh::makeBox({0.1, 0.08, 0.05}, {9, 9, 5}));
  // Where 12 points are asked: each of them factorizes finer elements of most of the block.
  const mesh::TetMesh coarser_ = heldBelow(mesh::makeBox({0.1, 0.08, 0.05}, {7, 7, 4}));
};

TEST_F(LockingBlock, LinearElementsLockAndQuadraticOnesDoNot) {
  const MeshError linear = errorOf(coarser_, 0.48), quadratic = errorOf(mesh::quadraticOf(coarser_), 0.48);
  EXPECT_EQ(linear.points, 12);
  EXPECT_EQ(quadratic.points, 12);
  EXPECT_GT(linear.mean, 0.08);
  EXPECT_LT(quadratic.mean, 0.03);
  EXPECT_LT(errorOf(coarser_, 0.3).mean, 0.6 * linear.mean);
  EXPECT_GE(linear.largest, linear.mean);
}

TEST_F(LockingBlock, FallWithTheElements) {
  std::vector<std::int32_t> all(coarser_.tetrahedra.size());
  std::iota(all.begin(), all.end(), 0);
  const mesh::TetMesh fine = heldBelow(mesh::eighthsOf(coarser_, all).mesh);
  EXPECT_LT(errorOf(fine, 0.4).mean, 0.6 * errorOf(coarser_, 0.4).mean);
}

/// n . K_s n in the middle of the upper side, a node of both meshes.
class Middle {
 public:
  explicit Middle(const mesh::TetMesh& mesh)
      : mesh_(mesh), setup_(caseOf(0.48), mesh_), factor_(setup_.model) {
    factor_.factorize(Eigen::VectorXd::Zero(3 * setup_.model.nodeCount()));
    const auto& X = setup_.surface.positions;
    const Vec3 middle(0.05, 0.04, 0.05);
    std::size_t node = 0;
    while ((X[node] - middle).norm() > 1e-9) ++node;
    s_ = setup_.surface.atNode(static_cast<int>(node));
  }
  [[nodiscard]] double stiffness() const {
    const Patch patch = makePatch(setup_.model, setup_.surface, s_, setup_.patch_radius);
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(setup_.model.dofCount(), 3);
    for (std::size_t i = 0; i < patch.nodes.size(); ++i)
      for (int c = 0; c < 3; ++c) G(setup_.model.dof(patch.nodes[i]) + c, c) = patch.weights[i];
    return Mat3((G.transpose() * factor_.solve(G)).inverse())(2, 2);
  }
  [[nodiscard]] double error() const { return *MeshErrors(setup_, mesh_, factor_).at(s_); }

 private:
  const mesh::TetMesh& mesh_;
  SolverSetup setup_;
  Cholesky factor_;
  ContactPoint s_;
};

TEST_F(LockingBlock, OfAPartAreNearlyThoseOfTheWhole) {
  std::vector<std::int32_t> all(coarse_.tetrahedra.size());
  std::iota(all.begin(), all.end(), 0);
  const mesh::TetMesh fine = mesh::quadraticOf(heldBelow(mesh::eighthsOf(coarse_, all).mesh));
  const mesh::TetMesh raised = mesh::quadraticOf(coarse_);
  const Middle coarse(raised);
  const double whole = coarse.stiffness() / Middle(fine).stiffness() - 1.0;
  EXPECT_GT(whole, 0.002);
  EXPECT_NEAR(coarse.error(), whole, 0.3 * whole);
}

/// The finer part has no springs, so a place with springs in reach is left out.
TEST_F(LockingBlock, APlaceOnSpringsIsLeftOut) {
  mesh::TetMesh bed = mesh::quadraticOf(coarse_);
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(bed.nodes.size()); ++node)
    if (bed.nodes[static_cast<std::size_t>(node)].x() < 1e-9) bed.groups["bed"].push_back(node);
  Case c = caseOf(0.48);
  c.springs.push_back({"bed", 1e6, "here"});
  const SolverSetup setup(c, bed);
  ASSERT_FALSE(setup.model.springs().empty());
  Cholesky factor(setup.model);
  factor.factorize(Eigen::VectorXd::Zero(3 * setup.model.nodeCount()));
  const MeshErrors errors(setup, bed, factor);
  bool with = false, without = false;
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(setup.surface.faces.size()) && !(with && without);
       ++f) {
    const ContactPoint s{f, {0.3, 0.3, 0.4}};
    const Vec3 x = setup.surface.position(s);
    if (x.z() < 0.049 || (x.x() > 0.02 && x.x() < 0.08)) continue;
    const bool near = x.x() < 0.02;
    if (near ? with : without) continue;
    EXPECT_EQ(errors.at(s).has_value(), !near) << x.transpose();
    (near ? with : without) = true;
  }
  EXPECT_TRUE(with && without);
}

TEST_F(LockingBlock, OfLinearElementsAreThoseAgainstQuadraticOnes) {
  const mesh::TetMesh raised = mesh::quadraticOf(coarse_);
  const Middle linear(coarse_);
  EXPECT_NEAR(linear.error(), linear.stiffness() / Middle(raised).stiffness() - 1.0, 1e-6);
}

}  // namespace
}  // namespace palpate::solver
