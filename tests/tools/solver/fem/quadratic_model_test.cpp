// SPDX-License-Identifier: Apache-2.0
// Bodies of ten-node tetrahedra, by the same solvers as linear ones.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "../quadratic_box.h"
#include "tools/solver/fem/newton.h"
#include "tools/solver/fit/field_measures.h"

namespace palpate::solver {
namespace {

const Material kSteady{{160e3, 0.48}};

/// How far the tip of a cantilever moves under a small load across it, m.
double tipOf(const FeModel& model, const Box& box) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * model.nodeCount());
  const auto middle = [&](const Vec3& X) {
    return (X - Vec3(box.size.x(), 0.5 * box.size.y(), 0.5 * box.size.z())).norm() < 1e-9;
  };
  int tip = 0;
  while (!middle(model.nodes()[static_cast<std::size_t>(tip)])) ++tip;
  load[3 * tip + 2] = 1e-6;
  const NewtonResult result = NewtonSolver(model).solveLoad(load, {});
  double moved = 0.0;  // of the axis near the tip, away from the load's own dent
  for (int i = 0; i < model.nodeCount(); ++i) {
    const Vec3 from = model.nodes()[static_cast<std::size_t>(i)] -
                      Vec3(0.875 * box.size.x(), 0.5 * box.size.y(), 0.5 * box.size.z());
    if (from.norm() < 1e-9) moved = result.u[3 * i + 2];
  }
  return moved;
}

TEST(QuadraticModel, DoesNotLockWhereLinearElementsDo) {
  const Box coarse{8, 2, 2, Vec3(0.08, 0.02, 0.02)}, fine{16, 4, 4, coarse.size};
  const double wanted = tipOf(quadraticModel(fine, kSteady), fine);
  ASSERT_GT(wanted, 0.0);
  EXPECT_NEAR(tipOf(quadraticModel(coarse, kSteady), coarse), wanted, 0.05 * wanted);
  EXPECT_LT(tipOf(coarse.clamped(kSteady), coarse), 0.6 * wanted);
}

TEST(QuadraticModel, IsTheWholeBox) {
  const Box box{3, 2, 2, Vec3(0.03, 0.02, 0.02)};
  const FeModel model = quadraticModel(box, kSteady);
  double volume = 0.0;
  for (int e = 0; e < model.elementCount(); ++e) {
    volume += model.volume(e);
    EXPECT_EQ(model.elementNodes(e).size(), 10U);
  }
  EXPECT_NEAR(volume, box.size.prod(), 1e-12 * volume);
}

/// int |u|^2 of u = (x^2, 0, 0), which these elements hold exactly: L^5 A / 5.
TEST(QuadraticModel, NormOfAQuadraticFieldIsExact) {
  const Box box{3, 2, 2, Vec3(0.03, 0.02, 0.02)};
  const FeModel model = quadraticModel(box, kSteady);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * model.nodeCount());
  for (int i = 0; i < model.nodeCount(); ++i)
    u[3 * i] = std::pow(model.nodes()[static_cast<std::size_t>(i)].x(), 2);
  EXPECT_NEAR(normL2(model, u), std::sqrt(std::pow(0.03, 5) / 5.0 * 0.02 * 0.02), 1e-12);
}

/// An element whose Gauss points are fine may be inside out at a node.
TEST(QuadraticModel, DetFIsLookedAtInTheNodesToo) {
  const Box box{1, 1, 1, Vec3(0.01, 0.01, 0.01)};
  const FeModel model = quadraticModel(box, kSteady);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * model.nodeCount());
  const std::int32_t corner = box.node(1, 1, 1);
  u.segment<3>(3 * corner) = Vec3::Constant(-0.005);  // to the middle of the diagonal's last half
  const double at_points = smallestDetF(std::span(std::get<1>(model.points())), u);
  EXPECT_LT(model.minDetF(u), 0.0);
  EXPECT_GT(at_points, 0.0);
}

TEST(QuadraticModel, RefusesANodeThatIsNotInTheMiddleOfItsEdge) {
  mesh::TetMesh mesh = quadraticMesh({1, 1, 1, Vec3(0.01, 0.01, 0.01)});
  mesh.nodes[static_cast<std::size_t>(mesh.midsides[2][4])].x() += 1e-4;
  try {
    const FeModel model(mesh.nodes, {mesh.tetrahedra, mesh.midsides}, {}, kSteady);
    FAIL() << "taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("from the middle of its edge"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace palpate::solver
