// SPDX-License-Identifier: Apache-2.0
// A model of quadratic elements: contact positions at corners, patches on the nodes between them.
#include <memory>
#include <random>

#include "block_model.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/quadratic.h"
#include "tools/solver/fem/cholesky.h"
#include "tools/solver/series/series.h"

namespace palpate::solver {
namespace {

class QuadraticBlock : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    Case third;  // the degree that edges have
    third.order = 3;
    world_ = std::make_unique<BlockModel>(mesh::quadraticOf(mesh::makeBox(kSize, {6, 5, 4})), third);
  }
  static void TearDownTestSuite() { world_.reset(); }

  Vec3 travel(double length) {
    return length * Vec3(normal_(random_), normal_(random_), normal_(random_)).normalized();
  }
  /// A point of a face, two rings from the clamped end, and so far from the block's edges.
  ContactPoint anywhere(double margin = 0.0) {
    std::uniform_real_distribution<double> uniform;
    ContactPoint s;
    Vec3 x;
    int near = 0;  // sides of the block
    do {
      s.triangle = static_cast<std::int32_t>(random_() % world_->surface.faces.size());
      const double root = std::sqrt(uniform(random_)), part = uniform(random_);
      s.barycentric = {1.0 - root, root * (1.0 - part), root * part};
      x = world_->surface.position(s);
      near = 0;
      for (Eigen::Index i = 0; i < 3; ++i) near += std::min(x[i], kSize[i] - x[i]) < margin ? 1 : 0;
    } while (x.x() < 0.025 || near > 1);
    return s;
  }

  static inline const Vec3 kSize{0.06, 0.05, 0.04};
  static std::unique_ptr<BlockModel> world_;
  std::mt19937 random_{3};
  std::normal_distribution<double> normal_;
};

std::unique_ptr<BlockModel> QuadraticBlock::world_;

TEST_F(QuadraticBlock, HasPositionsAtCornersAndLoadsBetweenThem) {
  const MetaModel model = MetaModel::load(world_->file.path());
  const ModelView& view = model.view();
  EXPECT_EQ(view.triangles(), 4 * view.contactTriangles());
  const std::vector<bool> corner = world_->surface.corners();
  for (const std::int32_t node : view.contact_node) EXPECT_TRUE(corner[static_cast<std::size_t>(node)]);
  const Patch patch = makePatch(world_->fe, world_->surface, anywhere(), world_->setup.patch_radius);
  EXPECT_GT(patch.nodes.size(), 10U);
  for (const std::int32_t node : patch.nodes) {
    const auto place = std::find(world_->surface.nodes.begin(), world_->surface.nodes.end(), node);
    EXPECT_FALSE(corner[static_cast<std::size_t>(place - world_->surface.nodes.begin())]) << node;
  }
}

/// What the viewer's page and scripted tools look at: the nodes of drawn triangles.
TEST_F(QuadraticBlock, TheFaceOfThreeAccessibleCornersIsAccessibleAllOver) {
  const MetaModel model = MetaModel::load(world_->file.path());
  const ModelView& view = model.view();
  const std::vector<std::uint8_t> accessible = model.accessibleNodes();
  std::size_t all = 0, none = 0;
  for (std::size_t f = 0; f < view.contactTriangles(); ++f) {
    const auto at = [&](std::int32_t node) { return accessible[static_cast<std::size_t>(node)] != 0; };
    const auto corner = view.contact_triangles.subspan(3 * f, 3),
               drawn = view.surface_triangles.subspan(12 * f, 12);
    const auto touchable = std::count_if(corner.begin(), corner.end(), at);
    all += touchable == 3 ? 1 : 0;
    none += touchable == 0 ? 1 : 0;
    EXPECT_EQ(touchable == 3, std::all_of(drawn.begin(), drawn.end(), at)) << f;
    if (touchable < 2) {
      EXPECT_TRUE(std::none_of(drawn.begin() + 9, drawn.end(), at)) << f;
    }
  }
  EXPECT_GT(all, 100U);
  EXPECT_GT(none, 10U);
}

TEST_F(QuadraticBlock, AnswersLikeNewtonAtCorners) {
  const MetaModel model = MetaModel::load(world_->file.path());
  for (int i = 0; i < 8; ++i) {
    std::size_t position = 0;
    do position = random_() % world_->setup.positions.nodes.size();
    while (world_->surface.positions[static_cast<std::size_t>(world_->setup.positions.nodes[position])].x() <
           0.03);
    const BlockModel::Errors errors =
        world_->compare(model, world_->surface.atNode(world_->setup.positions.nodes[position]), travel(1e-3));
    EXPECT_LT(errors.force, 5e-5);
    EXPECT_LT(errors.field, 0.01);
  }
}

/// The linear part has a solve's accuracy there: K_s between its places, and the field up to what the modes miss.
TEST_F(QuadraticBlock, SmallTouchesBetweenCornersAreAsNewtonSays) {
  const MetaModel model = MetaModel::load(world_->file.path());
  for (int i = 0; i < 8; ++i) {
    const BlockModel::Errors errors = world_->compare(model, anywhere(0.008), travel(1e-7));
    EXPECT_LT(errors.force, 2e-3);
    EXPECT_LT(errors.field, 5e-3);
  }
}

/// In the middle of an edge the orders of two and more are those of the patch there.
TEST_F(QuadraticBlock, EdgesAddWhatTheMixtureOfPositionsLacks) {
  modelfile::ModelData mixed = world_->data;
  ASSERT_EQ(mixed.edge_order, 3);
  mixed.edge_order = 0;
  mixed.edge_offset.clear(), mixed.edge_node.clear(), mixed.edge_field.clear();
  const palpate::testing::TemporaryFile file("mixed.h5");
  modelfile::writeModel(file.path(), mixed);
  const MetaModel model = MetaModel::load(world_->file.path()), without = MetaModel::load(file.path());
  Cholesky factor(world_->fe);
  factor.factorize(Eigen::VectorXd::Zero(3 * world_->fe.nodeCount()));
  SeriesSolver series(world_->fe, factor, model.attributes().order);
  std::vector<double> power(static_cast<std::size_t>(series.basis().size()));
  double error = 0.0, error_without = 0.0;
  for (int i = 0; i < 8; ++i) {
    ContactPoint s = anywhere(0.012);
    s.barycentric = {0.0, 0.5, 0.5};
    const Vec3 d = travel(2e-3);
    const std::vector<Patch> patch{makePatch(world_->fe, world_->surface, s, world_->setup.patch_radius)};
    series.solve(patch);
    series.basis().evaluate(d, power);
    const auto bent = [&](const MetaModel& of) {  // the field less its linear part
      constexpr float kSmall = 1e-4F;
      FieldScratch scratch(of);
      std::vector<float> u(3 * world_->surface.nodes.size()), linear(u.size());
      evaluateField(of, s, d, scratch, u);
      evaluateField(of, s, double{kSmall} * d, scratch, linear);
      for (std::size_t k = 0; k < u.size(); ++k) u[k] -= linear[k] / kSmall;
      return u;
    };
    const auto off = [&](const std::vector<float>& u) {
      double largest = 0.0;
      for (std::size_t node = 0; node < world_->surface.nodes.size(); ++node) {
        if ((world_->surface.positions[node] - world_->surface.position(s)).norm() >
            1.5 * world_->setup.patch_radius)
          continue;  // there the modes' error is larger than what edges add
        Vec3 truth = Vec3::Zero();
        for (int k = 3; k < series.basis().size(); ++k)
          truth +=
              power[static_cast<std::size_t>(k)] * series.displacement(0, k, world_->surface.nodes[node]);
        const Vec3 own = Eigen::Map<const Eigen::Vector3f>(u.data() + 3 * node).cast<double>();
        largest = std::max(largest, (own - truth).norm());
      }
      return largest / d.norm();
    };
    error += off(bent(model)) / 8.0;
    error_without += off(bent(without)) / 8.0;
  }
  EXPECT_LT(error, 0.25 * error_without) << error << " and " << error_without << " of the travel";
  EXPECT_LT(error, 2e-3);
}

/// Across an edge of 90 degrees K_s has kinks that the mesh is too coarse for.
TEST_F(QuadraticBlock, AnswersBetweenCorners) {
  const MetaModel model = MetaModel::load(world_->file.path());
  for (int i = 0; i < 8; ++i) {
    const Vec3 d = travel(1e-3);
    const BlockModel::Errors flat = world_->compare(model, anywhere(0.008), d);
    EXPECT_LT(flat.force, 0.01);
    EXPECT_LT(flat.field, 0.01);
    const BlockModel::Errors edge = world_->compare(model, anywhere(), d);
    EXPECT_LT(edge.force, 0.02);
    EXPECT_LT(edge.field, 0.05);
  }
}

/// Where the tool is, in the middle of an edge, the tick's table says what the whole field says.
TEST_F(QuadraticBlock, TheDimpleIsTheFieldThere) {
  const MetaModel model = MetaModel::load(world_->file.path());
  FieldScratch scratch(model);
  std::vector<float> u(3 * world_->surface.nodes.size());
  for (int i = 0; i < 8; ++i) {
    ContactPoint s = anywhere();
    s.barycentric = {0.0, 0.5, 0.5};  // a node in the middle of an edge
    const Vec3 d = travel(2e-3);
    evaluateField(model, s, d, scratch, u);
    const FieldSource source{s, d, 1.0};
    Vec3 here;
    fieldAt(model, {&source, 1}, scratch, {&s, 1}, {&here, 1});
    const NodeMix nodes = model.surface().nodesAt(s);
    Vec3 there = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      there += nodes.weight[k] *
               Eigen::Map<const Eigen::Vector3f>(u.data() + 3 * static_cast<std::size_t>(nodes.node[k]))
                   .cast<double>();
    EXPECT_LT((here - there).norm(), 1e-4 * d.norm());
  }
}

/// Mixing is worst in the middle of an edge, and d_max knows of it.
TEST_F(QuadraticBlock, AtTheEndOfTheDomainTheMiddlesOfEdgesAreRight) {
  const MetaModel model = MetaModel::load(world_->file.path());
  double force = 0.0, field = 0.0;
  for (int i = 0; i < 16; ++i) {
    ContactPoint s = anywhere();
    s.barycentric = {0.0, 0.5, 0.5};
    const double d_max = model.response().domainRadius(model.surface().mix(s));
    const BlockModel::Errors errors = world_->compare(model, s, travel(0.999 * d_max));
    force = std::max(force, errors.force);
    field = std::max(field, errors.field);
  }
  EXPECT_LT(force, 0.015);
  EXPECT_LT(field, 0.01);
}

TEST_F(QuadraticBlock, FilesWithOtherFacesAreRefused) {
  const auto refused = [&](const auto& spoil, const std::string& expected) {
    modelfile::ModelData data = world_->data;
    spoil(data);
    const palpate::testing::TemporaryFile file("spoiled.h5");
    modelfile::writeModel(file.path(), data);
    try {
      (void)MetaModel::load(file.path());
      FAIL() << "accepted, expected: " << expected;
    } catch (const std::exception& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  };
  using modelfile::ModelData;
  refused([](ModelData& d) { d.contact_triangles.resize(d.contact_triangles.size() - 3); },
          "or a quarter of that");
  refused([](ModelData& d) { std::swap(d.contact_triangles[0], d.contact_triangles[1]); },
          "/surface/triangles number 0 is");
  refused([](ModelData& d) { d.surface_triangles[1] = d.surface_triangles[0]; },
          "/surface/triangles number 1 is");
  refused(
      [](ModelData& d) { d.surface_positions[3 * static_cast<std::size_t>(d.surface_triangles[9])] += 1e-4; },
      "the node in the middle of");
  refused(  // an edge with another middle in the neighbour's face
      [](ModelData& d) {
        const std::int32_t old = d.surface_triangles[9],
                           added = static_cast<std::int32_t>(d.surface_mesh_tag.size());
        for (std::size_t c = 0; c < 3; ++c)
          d.surface_positions.push_back(d.surface_positions[3 * static_cast<std::size_t>(old) + c]);
        d.surface_mesh_tag.push_back(1 << 20);
        d.position_of_node.push_back(-1);
        d.mesh_surface_node.push_back(d.mesh_surface_node[static_cast<std::size_t>(old)]);
        const std::size_t n = d.modes_X.size() / (3 * static_cast<std::size_t>(added));
        d.modes_X.resize(n * 3 * d.surface_mesh_tag.size());
        for (std::size_t i = 0; i < 12; ++i)
          if (d.surface_triangles[i] == old) d.surface_triangles[i] = added;
      },
      "one node in the middle of each edge");
  refused([](ModelData& d) { d.mesh_midsides.clear(); }, "/mesh/midsides is missing");
  refused([](ModelData& d) { d.mesh_midsides[7] = 1 << 20; }, "/mesh/midsides number 7 is 1048576");
  refused(
      [](ModelData& d) {
        const std::int32_t middle = d.surface_triangles[9];
        d.position_of_node[static_cast<std::size_t>(d.contact_node[0])] = -1;
        d.position_of_node[static_cast<std::size_t>(middle)] = 0;
        d.contact_node[0] = middle;
      },
      "/contact/node number 0 is");
}

}  // namespace
}  // namespace palpate::solver
