// SPDX-License-Identifier: Apache-2.0
// A handheld model of quadratic elements beside the one that a server has.
#include <algorithm>
#include <memory>
#include <random>

#include "block_model.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/quadratic.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/build/shared_loads.h"

namespace palpate::solver {
namespace {

mesh::TetMesh block() {
  return mesh::quadraticOf(mesh::makeBox({0.06, 0.05, 0.04}, {6, 5, 4}));
}

Case handheld(std::optional<double> limit) {
  Case c;
  c.target = Target::kHandheld;
  c.size_limit = limit;
  c.order = 3;
  return c;
}

class HandheldBlock : public ::testing::Test {
 protected:
  static constexpr double kLimit =
      1e6;  // leaves room for fewer modes than the block's fields have in float32
  static void SetUpTestSuite() {
    small_ = std::make_unique<BlockModel>(block(), handheld(kLimit), "small.h5");
    full_ = std::make_unique<BlockModel>(block(), Case{});
  }
  static void TearDownTestSuite() { small_.reset(), full_.reset(); }

  static inline std::unique_ptr<BlockModel> small_, full_;
};

TEST_F(HandheldBlock, IsWithinItsLimitAndUsesIt) {
  const auto bytes = static_cast<double>(std::filesystem::file_size(small_->file.path()));
  EXPECT_LE(bytes, kLimit);
  EXPECT_GT(bytes, 0.9 * kLimit);
  EXPECT_GT(static_cast<double>(std::filesystem::file_size(full_->file.path())), 3.0 * kLimit);
}

TEST_F(HandheldBlock, HasTheSameMesh) {
  ASSERT_EQ(small_->data.mesh_nodes.size(), full_->data.mesh_nodes.size());
  for (std::size_t i = 0; i < small_->data.mesh_nodes.size(); ++i)
    EXPECT_NEAR(small_->data.mesh_nodes[i], full_->data.mesh_nodes[i], 4e-9);
  EXPECT_EQ(small_->data.mesh_midsides, full_->data.mesh_midsides);
}

TEST_F(HandheldBlock, AsksForFewerTrianglesToSlideOn) {
  EXPECT_EQ(MetaModel::load(small_->file.path()).attributes().rounded_triangles, 75'000);
  EXPECT_EQ(MetaModel::load(full_->file.path()).attributes().rounded_triangles, kMostRoundedTriangles);
}

/// The force as exact as that of the full model, the field as far off as a picture may be.
TEST_F(HandheldBlock, AnswersLikeNewton) {
  const MetaModel model = MetaModel::load(small_->file.path());
  std::mt19937 random{5};
  std::normal_distribution<double> normal;
  std::vector<double> field;
  for (int i = 0; i < 12; ++i) {
    ContactPoint s;
    do s.triangle = static_cast<std::int32_t>(random() % small_->surface.faces.size());
    while (small_->surface.position({s.triangle, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}}).x() < 0.03);
    s.barycentric = {0.2, 0.3, 0.5};
    const Vec3 d = 1e-3 * Vec3(normal(random), normal(random), normal(random)).normalized();
    const BlockModel::Errors errors = small_->compare(model, s, d);
    EXPECT_LT(errors.force, 0.02);  // over an edge of 90 degrees, as of the full model
    field.push_back(errors.field);
  }
  std::sort(field.begin(), field.end());
  EXPECT_LT(field[field.size() / 2], 0.03);
  EXPECT_LT(field.back(), 0.04);
}

TEST_F(HandheldBlock, IsSolvedFromCornersAlone) {
  const std::vector<bool> corner = small_->surface.corners();
  for (const std::int32_t node : small_->data.green_node) EXPECT_TRUE(corner[static_cast<std::size_t>(node)]);
  EXPECT_LT(small_->data.green_node.size(), full_->data.green_node.size() / 2);
}

/// Loads that their ends share are those of the patch.
TEST_F(HandheldBlock, SharedLoadsAreThoseOfThePatch) {
  const SolverSetup& setup = small_->setup;
  const ContactPatches patches(setup.surface.graph, freeNodes(setup.model, setup.surface), setup.patch_radius,
                               setup.positions.nodes);
  const SharedLoads shared = sharedLoads(setup, patches, full_->data.green_node, 2);
  ASSERT_EQ(shared.R.rows(), static_cast<Eigen::Index>(full_->data.green_node.size()));
  EXPECT_LT(shared.error, 0.25);
  const Eigen::VectorXf sums = shared.R.colwise().sum().transpose();
  EXPECT_NEAR(sums.mean(), 1.0, 0.02);
}

TEST_F(HandheldBlock, SharedLoadsHaveTheSameBitsWithAnyThreads) {
  const SerialBlas serial;
  const SolverSetup& setup = small_->setup;
  const ContactPatches patches(setup.surface.graph, freeNodes(setup.model, setup.surface), setup.patch_radius,
                               setup.positions.nodes);
  const SharedLoads one = sharedLoads(setup, patches, full_->data.green_node, 1),
                    three = sharedLoads(setup, patches, full_->data.green_node, 3);
  EXPECT_EQ(one.R, three.R);
  EXPECT_EQ(one.error, three.error);
}

/// Whether all sources are summed at once or some at a time.
TEST(SharedLoads, FieldsAreTheSumsOfTheLoaded) {
  constexpr Eigen::Index kLoaded = 150, kSources = 70, kRows = 4;
  const std::filesystem::path scratch = std::filesystem::temp_directory_path();
  FieldTable greens(scratch, kLoaded, 3, kRows), fields(scratch, kSources, 3, kRows);
  const Eigen::MatrixXf W = Eigen::MatrixXf::Random(3 * kRows, kLoaded);
  for (Eigen::Index i = 0; i < kLoaded; ++i)
    greens.write(std::size_t(i), std::span(W.col(i).data(), 3 * kRows));
  const SharedLoads loads{std::vector<std::int32_t>(kSources), Eigen::MatrixXf::Random(kLoaded, kSources),
                          0.0};
  BuildOptions options;
  options.quiet = true;
  for (const std::size_t bytes : {std::size_t{1}, kSummedAtOnce}) {
    superpose(greens, loads, options, fields, bytes);
    Eigen::MatrixXf V(3 * kRows, kSources);
    for (Eigen::Index c = 0; c < kSources; ++c)
      fields.read(std::size_t(c), std::span(V.col(c).data(), 3 * kRows));
    EXPECT_LT((V - W * loads.R).cwiseAbs().maxCoeff(), 1e-4F) << bytes;
  }
}

/// If surface and force alone exceed the limit, the file is as small as it gets.
TEST_F(HandheldBlock, WithoutRoomTheFieldIsLeftToFewModes) {
  const BlockModel tiny(block(), handheld(1e5), "tiny.h5");
  EXPECT_GT(std::filesystem::file_size(tiny.file.path()), 100'000U);
  EXPECT_TRUE(tiny.data.near_node.empty());
  EXPECT_TRUE(tiny.data.green_near_node.empty());
  EXPECT_NO_THROW((void)MetaModel::load(tiny.file.path()));
}

}  // namespace
}  // namespace palpate::solver
