// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/fe_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "../boxes.h"
#include "tools/solver/fem/cholesky.h"

namespace palpate::solver {
namespace {

const Material kLiver{{160e3, 0.48}};

Eigen::VectorXd randomField(const FeModel& model, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  Eigen::VectorXd u(3 * model.nodeCount());
  for (double& x : u) x = uniform(random);
  for (const int node : model.fixedNodes()) u.segment<3>(3 * node).setZero();
  return u;
}

// A homogeneous deformation is in equilibrium inside, and every element carries the same stress.
TEST(PatchTest, HomogeneousDeformationLeavesNoForceInside) {
  const Box box{3, 3, 3, Vec3(0.03, 0.02, 0.04)};
  FeModel model(box.nodes(), {box.tetrahedra()}, {}, kLiver);
  const Mat3 H = (Mat3() << 0.1, 0.05, -0.02, 0.03, -0.08, 0.04, 0.0, 0.06, 0.12).finished();
  Eigen::VectorXd u(3 * model.nodeCount());
  for (int i = 0; i < model.nodeCount(); ++i)
    u.segment<3>(3 * i) = H * model.nodes()[static_cast<std::size_t>(i)];
  const Eigen::VectorXd f = model.internalForce(u);
  const double scale = f.cwiseAbs().maxCoeff();
  ASSERT_GT(scale, 0.1);
  for (int i = 1; i < 3; ++i)
    for (int j = 1; j < 3; ++j)
      for (int k = 1; k < 3; ++k) EXPECT_LT(f.segment<3>(3 * box.node(i, j, k)).norm(), 1e-12 * scale);
}

TEST(FeModel, ForceOnAFaceIsStressTimesArea) {
  const Box box{2, 2, 2, Vec3(0.02, 0.03, 0.04)};
  FeModel model(box.nodes(), {box.tetrahedra()}, {}, kLiver);
  const double stretch = 0.2;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * model.nodeCount());
  for (int i = 0; i < model.nodeCount(); ++i)
    u[3 * i] = stretch * model.nodes()[static_cast<std::size_t>(i)].x();
  Vec3 total = Vec3::Zero();
  const Eigen::VectorXd f = model.internalForce(u);
  for (const int node : box.face(0, true)) total += f.segment<3>(3 * node);
  const double strain = stretch + 0.5 * stretch * stretch;
  const double P =
      (1.0 + stretch) * (kLiver.elasticity.lame().lambda + 2.0 * kLiver.elasticity.lame().mu) * strain;
  EXPECT_NEAR(total.x(), P * 0.03 * 0.04, 1e-10 * std::abs(P) * 0.0012);
}

TEST(FeModel, TangentIsDerivativeOfForce) {
  const Box box{2, 1, 1, Vec3(0.02, 0.01, 0.01)};
  const FeModel model = box.clamped(kLiver);
  const Eigen::VectorXd u = randomField(model, 5e-4, 1);
  const Eigen::VectorXd v = randomField(model, 1.0, 2);
  Eigen::VectorXd Kv = Eigen::VectorXd::Zero(u.size());
  for (int e = 0; e < model.elementCount(); ++e) {
    const auto& t = model.tetrahedra().corners[static_cast<std::size_t>(e)];
    Eigen::Matrix<double, 12, 1> local;
    for (int a = 0; a < 4; ++a) local.segment<3>(3 * a) = v.segment<3>(3 * t[static_cast<std::size_t>(a)]);
    const Eigen::Matrix<double, 12, 1> out = model.elementTangent(e, u) * local;
    for (int a = 0; a < 4; ++a) Kv.segment<3>(3 * t[static_cast<std::size_t>(a)]) += out.segment<3>(3 * a);
  }
  const double h = 1e-7;
  const Eigen::VectorXd difference =
      (model.internalForce(u + h * v) - model.internalForce(u - h * v)) / (2.0 * h);
  EXPECT_LT((Kv - difference).norm(), 1e-7 * Kv.norm());
}

TEST(FeModel, ForceIsDerivativeOfEnergy) {
  const Box box{2, 1, 1, Vec3(0.02, 0.01, 0.01)};
  const FeModel model = box.clamped(kLiver);
  const Eigen::VectorXd u = randomField(model, 5e-4, 3);
  const Eigen::VectorXd v = randomField(model, 1.0, 4);
  const double h = 1e-7;
  const double difference = (model.energy(u + h * v) - model.energy(u - h * v)) / (2.0 * h);
  EXPECT_NEAR(model.internalForce(u).dot(v), difference, 1e-6 * std::abs(difference));
}

TEST(FeModel, RotationCostsNothing) {
  const Box box{2, 2, 2, Vec3(0.02, 0.02, 0.02)};
  FeModel model(box.nodes(), {box.tetrahedra()}, {}, kLiver);
  const Mat3 R = Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  Eigen::VectorXd u(3 * model.nodeCount());
  for (int i = 0; i < model.nodeCount(); ++i) {
    const Vec3& X = model.nodes()[static_cast<std::size_t>(i)];
    u.segment<3>(3 * i) = R * X - X;
  }
  EXPECT_LT(model.internalForce(u).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(FeModel, RefusesAFlatTetrahedron) {
  try {
    const std::vector<std::array<std::int32_t, 4>> flat{{0, 1, 2, 3}};
    const FeModel model({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)}, {flat}, {}, kLiver);
    FAIL() << "a flat tetrahedron was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("tetrahedron 0"), std::string::npos) << error.what();
  }
}

// Elements round nodes with i < 2 are soft, those round nodes with i > 2 three times as stiff.
TEST(FeModel, ForceIsThatOfEachElementsOwnStiffness) {
  const Box box{4, 1, 1, Vec3(0.04, 0.01, 0.01)};
  Material material = kLiver;
  material.regions = {{"soft", {160e3, 0.48}}, {"stiff", {480e3, 0.48}}};
  for (std::size_t e = 0; e < box.tetrahedra().size(); ++e)
    material.region_of_element.push_back(e < box.tetrahedra().size() / 2 ? 0 : 1);
  const FeModel even = box.clamped(kLiver), uneven = box.clamped(material);
  const Eigen::VectorXd u = randomField(even, 5e-4, 5);
  const Eigen::VectorXd f = even.internalForce(u), g = uneven.internalForce(u);
  for (int i : {0, 1, 3, 4})
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 2; ++k) {
        const int at = 3 * box.node(i, j, k);
        EXPECT_LT((g.segment<3>(at) - (i < 2 ? 1.0 : 3.0) * f.segment<3>(at)).norm(), 1e-12 * f.norm());
      }
}

TEST(FeModel, RefusesElementsWithoutARegionAndRegionsThatThereAreNot) {
  const Box box{1, 1, 1, Vec3(1, 1, 1)};
  Material material = kLiver;
  material.regions.resize(2);
  material.region_of_element.assign(5, 0);
  EXPECT_THROW((void)box.clamped(material), std::invalid_argument);
  material.region_of_element.assign(6, 1);
  EXPECT_NO_THROW((void)box.clamped(material));
  material.region_of_element[3] = 2;
  EXPECT_THROW((void)box.clamped(material), std::invalid_argument);
  material.region_of_element.assign(6, 1);
  material.regions[1].elasticity.nu = 0.5;
  EXPECT_THROW((void)box.clamped(material), std::invalid_argument);
}

/// Two laws, one for each half, and springs under one face, one of them at a node that has two.
FeModel mixedBody() {
  const Box box{3, 2, 2, Vec3(0.03, 0.02, 0.02)};
  Material material = kLiver;
  material.regions = {{"a", {160e3, 0.48}, StVenantKirchhoff{}}, {"b", {480e3, 0.3}, StableNeoHookean{}}};
  for (std::size_t e = 0; e < box.tetrahedra().size(); ++e)
    material.region_of_element.push_back(e % 5 < 2 ? 0 : 1);
  std::vector<Spring> springs;
  for (const std::int32_t node : box.face(2, false)) springs.push_back({node, 100.0 + node});
  springs.push_back(springs.back());
  return FeModel(box.nodes(), {box.tetrahedra()}, box.face(0, false), material, springs);
}

TEST(FeModel, OfTwoLawsOnSpringsHasItsForceFromItsEnergyAndItsTangentFromItsForce) {
  const FeModel model = mixedBody();
  const Eigen::VectorXd u = randomField(model, 5e-4, 7), v = randomField(model, 1.0, 8);
  const double h = 1e-7;
  const Eigen::VectorXd f = model.internalForce(u);
  const double slope = (model.energy(u + h * v) - model.energy(u - h * v)) / (2.0 * h);
  EXPECT_NEAR(f.dot(v), slope, 1e-6 * std::abs(slope));
  const Eigen::VectorXd wanted =
      (model.internalForce(u + h * v) - model.internalForce(u - h * v)) / (2.0 * h);
  Eigen::VectorXd found = Eigen::VectorXd::Zero(v.size());
  for (int e = 0; e < model.elementCount(); ++e) {
    const FeModel::ElementMatrix K = model.elementTangent(e, u);
    const auto nodes = model.elementNodes(e);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::size_t b = 0; b < nodes.size(); ++b)
        found.segment<3>(3 * nodes[a]) +=
            K.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b)) *
            v.segment<3>(3 * nodes[b]);
  }
  EXPECT_LT((found - wanted).norm(), 1e-6 * wanted.norm());
}

TEST(FeModel, RefusesASpringThatPushesOrHasNoNode) {
  const Box box{1, 1, 1, Vec3(1, 1, 1)};
  const auto with = [&](const Spring& spring) {
    return FeModel(box.nodes(), {box.tetrahedra()}, {}, kLiver, {spring});
  };
  EXPECT_NO_THROW((void)with({7, 1.0}));
  EXPECT_THROW((void)with({8, 1.0}), std::invalid_argument);
  EXPECT_THROW((void)with({7, -1.0}), std::invalid_argument);
}

TEST(FeModel, RefusesAnIncompressibleMaterial) {
  const Box box{1, 1, 1, Vec3(1, 1, 1)};
  EXPECT_THROW((void)box.clamped({{160e3, 0.5}}), std::invalid_argument);
}

TEST(Cholesky, SolvesWhatTheElementsAddUpTo) {
  const Box box{3, 2, 2, Vec3(0.03, 0.02, 0.02)};
  const FeModel model = box.clamped(kLiver);
  Cholesky factor(model);
  factor.factorize(Eigen::VectorXd::Zero(3 * model.nodeCount()));
  ASSERT_TRUE(factor.positiveDefinite());
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(model.dofCount(), 3);
  const Eigen::MatrixXd x = factor.solve(b);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * model.nodeCount());
  const double small = 1e-9 / x.cwiseAbs().maxCoeff();  // linear: f_int(small x) = small b
  for (int node = 0; node < model.nodeCount(); ++node)
    if (model.isFree(node)) u.segment<3>(3 * node) = small * x.col(1).segment<3>(model.dof(node));
  const Eigen::VectorXd f = model.internalForce(u) / small;
  for (int node = 0; node < model.nodeCount(); ++node)
    if (model.isFree(node)) {
      EXPECT_LT((f.segment<3>(3 * node) - b.col(1).segment<3>(model.dof(node))).norm(), 1e-4);
    }
}

}  // namespace
}  // namespace palpate::solver
