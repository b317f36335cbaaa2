// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/build_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <random>
#include <span>

#include "block_model.h"
#include "core/model/touch_patch.h"
#include "tools/mesh/box_mesh.h"

namespace palpate::solver {
namespace {

/// Solved once for all tests.
class SolvedBlock : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    Case c;
    c.patch_radius = 0.009;
    c.modes = 160;
    c.near_radius = 0.027;
    world_ = std::make_unique<BlockModel>(mesh::makeBox(Vec3(0.06, 0.05, 0.04), {9, 8, 7}), c);
  }
  static void TearDownTestSuite() { world_.reset(); }

  static std::unique_ptr<BlockModel> world_;
};

std::unique_ptr<BlockModel> SolvedBlock::world_;

TEST_F(SolvedBlock, AnswersLikeNewtonAtNodes) {
  const MetaModel model = MetaModel::load(world_->file.path());
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 8; ++i) {
    int node = 0;
    // Two rings from the clamped end: positions beside it answer for less than 1.5 mm.
    do node = static_cast<int>(random() % world_->surface.nodes.size());
    while (world_->surface.positions[static_cast<std::size_t>(node)].x() < 0.03);
    const Vec3 d = 1.5e-3 * Vec3(normal(random), normal(random), normal(random)).normalized();
    const BlockModel::Errors errors = world_->compare(model, world_->surface.atNode(node), d);
    EXPECT_LT(errors.force, 2e-5);
    EXPECT_LT(errors.field, 0.01);
  }
}

// No point between the nodes was in the fit; there, orders of two and more are mixed of three patches'.
TEST_F(SolvedBlock, AnswersBetweenNodesThatWereNotInTheFit) {
  const MetaModel model = MetaModel::load(world_->file.path());
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 8; ++i) {
    ContactPoint s{0, {0.3, 0.3, 0.4}};
    do s.triangle = static_cast<int>(random() % world_->surface.triangles.size());
    while (world_->surface.position(s).x() < 0.02);
    const Vec3 d = 1.5e-3 * Vec3(normal(random), normal(random), normal(random)).normalized();
    const BlockModel::Errors errors = world_->compare(model, s, d);
    EXPECT_LT(errors.force, 0.01);
    EXPECT_LT(errors.field, 0.015);  // some are at edges of the block, across which they are mixed
  }
}

// The linear part has a solve's accuracy there: K_s between its places, and the field up to what the modes miss.
TEST_F(SolvedBlock, SmallTouchesBetweenNodesAreAsNewtonSays) {
  const MetaModel model = MetaModel::load(world_->file.path());
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 6; ++i) {
    ContactPoint s{0, {0.2, 0.3, 0.5}};
    do s.triangle = static_cast<int>(random() % world_->surface.triangles.size());
    while (world_->surface.position(s).x() < 0.02);
    const Vec3 d = 1e-7 * Vec3(normal(random), normal(random), normal(random)).normalized();
    const BlockModel::Errors errors = world_->compare(model, s, d);
    EXPECT_LT(errors.force, 1e-3);
    EXPECT_LT(errors.field, 0.01);
  }
}

/// The average motion of a patch by unit forces on another, column by force, m/N.
Mat3 movedByUnitForces(const TouchPatch& from, const TouchPatch& to) {
  std::array<float, TouchPatch::kWeights * kNodeFloats> near{};
  to.average(from.near().sum, near.data());
  Mat3 C = Eigen::Map<const Eigen::Matrix3f>(near.data()).cast<double>();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::span<const float> amplitudes = from.load(axis);
    for (std::size_t c = 0; c < 3; ++c)
      C(static_cast<int>(c), static_cast<int>(axis)) +=
          std::inner_product(amplitudes.begin(), amplitudes.end(), to.modes() + c * amplitudes.size(), 0.0);
  }
  return C;
}

TEST_F(SolvedBlock, WhatOnePatchDoesToAnotherIsWhatThatDoesToIt) {
  const MetaModel model = MetaModel::load(world_->file.path());
  const auto patchAt = [&](const ContactPoint& s) {
    TouchPatch patch(model);
    patch.moveTo(model, s);
    patch.findNear(model);
    return patch;
  };
  std::mt19937 random(10);
  double worst = 0.0;
  for (int i = 0; i < 40; ++i) {
    std::array<ContactPoint, 2> s{ContactPoint{0, {0.2, 0.3, 0.5}}, ContactPoint{0, {0.6, 0.3, 0.1}}};
    for (ContactPoint& point : s) do
        point.triangle = static_cast<int>(random() % world_->surface.triangles.size());
      while (world_->surface.position(point).x() < 0.02);
    const std::array<TouchPatch, 2> patch{patchAt(s[0]), patchAt(s[1])};
    const Mat3 there = movedByUnitForces(patch[0], patch[1]), back = movedByUnitForces(patch[1], patch[0]);
    worst = std::max(worst, (there - back.transpose()).norm() / movedByUnitForces(patch[0], patch[0]).norm());
  }
  EXPECT_LT(worst, 0.01);
  EXPECT_GT(worst, 1e-7) << "the modes leave something out";
}

// What is sent and drawn may end before them.
TEST_F(SolvedBlock, ClampedNodesComeLastAndStay) {
  const MetaModel model = MetaModel::load(world_->file.path());
  const ModelView& view = model.view();
  bool clamped = false;
  for (std::size_t i = 0; i < view.surfaceNodes(); ++i) {
    const bool held = !world_->fe.isFree(view.mesh_surface_node[i]);
    EXPECT_LE(clamped, held) << "node " << i << " is free behind clamped ones";
    clamped = held;
    for (std::size_t mode = 0; held && mode < view.modes(); ++mode)
      for (std::size_t axis = 0; axis < 3; ++axis)
        ASSERT_EQ(view.modes_X[(3 * i + axis) * view.modes() + mode], 0);
  }
  EXPECT_TRUE(clamped);
}

TEST_F(SolvedBlock, HelpersAreNotAccessible) {
  const MetaModel model = MetaModel::load(world_->file.path());
  int helpers = 0;
  for (std::size_t p = 0; p < model.view().positions(); ++p) {
    const auto node = static_cast<std::size_t>(model.view().contact_node[p]);
    const bool held = world_->surface.positions[node].x() < 1e-9;
    EXPECT_EQ(model.view().contact_accessible[p] == 0, held);
    helpers += held ? 1 : 0;
  }
  EXPECT_GT(helpers, 0);
}

TEST(SolverSetup, RefusesPatchesOfTooManyNodes) {
  mesh::TetMesh organ = mesh::makeBox(Vec3(0.06, 0.06, 0.06), {24, 24, 24});
  organ.groups["fixed"] = {0};
  Case c;
  c.mesh = "block";
  c.patch_radius = 0.029;
  try {
    const SolverSetup setup(c, organ);
    FAIL() << setup.positions.nodes.size();
  } catch (const CaseError& error) {
    EXPECT_NE(std::string(error.what()).find("model.patch_radius is 0.029"), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("at most 2048 nodes"), std::string::npos) << error.what();
  }
}

TEST_F(SolvedBlock, RefusesAGroupThatIsNotThereAndListsThoseThatAre) {
  Case c = world_->c;
  c.fixed = "ligament";
  BuildReport report;
  try {
    (void)buildModel(c, world_->organ, {}, report);
    FAIL() << "an unknown group was taken";
  } catch (const CaseError& error) {
    EXPECT_NE(std::string(error.what()).find("\"ligament\""), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("fixed"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace palpate::solver
