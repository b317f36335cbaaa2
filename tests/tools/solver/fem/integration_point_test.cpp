// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/integration_point.h"

#include <gtest/gtest.h>

#include <random>

#include "../quadratic_box.h"

namespace palpate::solver {
namespace {

using StVK = StVenantKirchhoff;

/// The loops over integration points, with elements of 10 nodes.
class QuadraticElements : public ::testing::Test {
 protected:
  const Box box_{2, 2, 2, Vec3(0.02, 0.03, 0.02)};
  const QuadraticBox body_{box_};
  const std::span<const IntegrationPoint<10>> points_{body_.points};

  [[nodiscard]] Eigen::VectorXd random(double size, unsigned seed) const {
    std::mt19937 numbers(seed);
    std::uniform_real_distribution<double> uniform(-size, size);
    return Eigen::VectorXd::NullaryExpr(body_.size(), [&] { return uniform(numbers); });
  }
  [[nodiscard]] Eigen::VectorXd force(const Eigen::VectorXd& u) const {
    Eigen::VectorXd f = Eigen::VectorXd::Zero(u.size());
    addInternalForce<StVK>(points_, u, f);
    return f;
  }
};

TEST_F(QuadraticElements, WeightsAddUpToTheVolume) {
  double volume = 0.0;
  for (const auto& point : points_) volume += point.weight;
  EXPECT_NEAR(volume, box_.size.prod(), 1e-12 * volume);
}

TEST_F(QuadraticElements, DisplacementGradientOfAHomogeneousDeformationIsExact) {
  const Mat3 H = (Mat3() << 0.1, 0.05, -0.02, 0.03, -0.08, 0.04, 0.0, 0.06, 0.12).finished();
  Eigen::VectorXd u(body_.size());
  for (std::size_t i = 0; i < body_.nodes.size(); ++i)
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) = H * body_.nodes[i];
  for (const auto& point : points_) EXPECT_LT((displacementGradient(point, u) - H).norm(), 1e-12);
  EXPECT_NEAR(smallestDetF(points_, u), (Mat3::Identity() + H).determinant(), 1e-12);
}

TEST_F(QuadraticElements, HomogeneousStressIsInEquilibriumInside) {
  const Mat3 H = (Mat3() << 0.1, 0.05, -0.02, 0.03, -0.08, 0.04, 0.0, 0.06, 0.12).finished();
  Eigen::VectorXd u(body_.size());
  for (std::size_t i = 0; i < body_.nodes.size(); ++i)
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) = H * body_.nodes[i];
  std::vector<IntegrationPoint<10>> equal = body_.points;
  for (auto& point : equal) point.lame = equal.front().lame;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(u.size());
  addInternalForce<StVK>(std::span<const IntegrationPoint<10>>(equal), u, f);
  const double scale = f.cwiseAbs().maxCoeff();
  ASSERT_GT(scale, 0.1);
  int inside = 0;
  for (std::size_t i = 0; i < body_.nodes.size(); ++i) {
    const Eigen::Array3d x = body_.nodes[i].array() / box_.size.array();
    if ((x < 0.01).any() || (x > 0.99).any()) continue;
    ++inside;
    EXPECT_LT(f.segment<3>(static_cast<Eigen::Index>(3 * i)).norm(), 1e-12 * scale);
  }
  EXPECT_GT(inside, 10);
}

TEST_F(QuadraticElements, ForceIsDerivativeOfEnergy) {
  const Eigen::VectorXd u = random(3e-4, 1), v = random(1.0, 2);
  const double h = 1e-7;
  const double difference =
      (elasticEnergy<StVK>(points_, u + h * v) - elasticEnergy<StVK>(points_, u - h * v)) / (2.0 * h);
  EXPECT_NEAR(force(u).dot(v), difference, 1e-6 * std::abs(difference));
}

TEST_F(QuadraticElements, TangentIsDerivativeOfForce) {
  const Eigen::VectorXd u = random(3e-4, 3), v = random(1.0, 4);
  Eigen::VectorXd Kv = Eigen::VectorXd::Zero(u.size());
  for (std::size_t first = 0; first < points_.size(); first += 4) {
    const Eigen::Matrix<double, 30, 30> K = tangentOf<StVK>(points_.subspan(first, 4), u);
    EXPECT_LT((K - K.transpose()).norm(), 1e-12 * K.norm());
    const auto& nodes = points_[first].nodes;
    Eigen::Matrix<double, 30, 1> local;
    for (int a = 0; a < 10; ++a)
      local.segment<3>(3 * a) = v.segment<3>(3 * nodes[static_cast<std::size_t>(a)]);
    const Eigen::Matrix<double, 30, 1> out = K * local;
    for (int a = 0; a < 10; ++a)
      Kv.segment<3>(3 * nodes[static_cast<std::size_t>(a)]) += out.segment<3>(3 * a);
  }
  const double h = 1e-7;
  const Eigen::VectorXd difference = (force(u + h * v) - force(u - h * v)) / (2.0 * h);
  EXPECT_LT((Kv - difference).norm(), 1e-7 * Kv.norm());
}

}  // namespace
}  // namespace palpate::solver
