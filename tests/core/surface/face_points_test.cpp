// SPDX-License-Identifier: Apache-2.0
// Faces of quadratic elements: one triangle for contact, four flat ones for fields and distances.
#include "core/surface/face_points.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <random>
#include <vector>

#include "core/surface/surface_distance.h"
#include "core/surface/surface_mesh.h"

namespace palpate::testing {
namespace {

/// An octahedron whose faces have nodes in the middle of their edges.
struct Octahedron {
  std::vector<double> positions{1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
  std::vector<std::int32_t> faces{0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  std::vector<std::int32_t> triangles;

  Octahedron() {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    for (std::size_t f = 0; f < faces.size(); f += 3) {
      std::array<std::int32_t, 3> across{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t a = faces[f + (k + 1) % 3], b = faces[f + (k + 2) % 3];
        const auto [found, is_new] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(positions.size() / 3));
        across[k] = found->second;
        for (std::size_t c = 0; is_new && c < 3; ++c)
          positions.push_back(0.5 * (positions[3 * std::size_t(a) + c] + positions[3 * std::size_t(b) + c]));
      }
      triangles.insert(triangles.end(),
                       {faces[f], across[2], across[1], across[2], faces[f + 1], across[0], across[1],
                        across[0], faces[f + 2], across[0], across[1], across[2]});
    }
  }
  [[nodiscard]] Vec3 at(std::int32_t node) const {
    return Eigen::Map<const Vec3>(positions.data() + 3 * std::size_t(node));
  }
};

class FacePoints : public ::testing::Test {
 protected:
  FacePoints() {
    view_.surface_positions = organ_.positions;
    view_.surface_triangles = organ_.triangles;
    view_.contact_triangles = organ_.faces;
    view_.position_of_node = positions_;
    view_.contact_accessible = accessible_;
  }
  Octahedron organ_;
  std::vector<std::int32_t> positions_ = std::vector<std::int32_t>(organ_.positions.size() / 3, -1);
  std::vector<std::uint8_t> accessible_;
  ModelView view_;
};

TEST_F(FacePoints, APartAndItsFaceAreOnePoint) {
  const SurfaceMesh surface(view_);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 200; ++i) {
    const double root = std::sqrt(uniform(random)), part = uniform(random);
    const ContactPoint s{i % surface.triangles(), {1.0 - root, root * (1.0 - part), root * part}};
    const ContactPoint back = faceOf(partOf(s));
    EXPECT_EQ(back.triangle, s.triangle);
    const NodeMix nodes = surface.nodesAt(s);
    Vec3 x = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(back.barycentric[k], s.barycentric[k], 1e-15);
      EXPECT_GE(nodes.weight[k], 0.0);
      x += nodes.weight[k] * organ_.at(nodes.node[k]);
    }
    EXPECT_LT((x - surface.position(s)).norm(), 1e-15);
  }
}

TEST_F(FacePoints, EveryNodeIsAPointOfTheSurfaceAndHasANormal) {
  const SurfaceMesh surface(view_);
  const SurfaceGraph graph(organ_.positions, organ_.triangles, organ_.faces);
  ASSERT_EQ(surface.nodes(), 18);
  for (int node = 0; node < surface.nodes(); ++node) {
    EXPECT_LT((surface.position(surface.atNode(node)) - organ_.at(node)).norm(), 1e-15) << node;
    EXPECT_LT((surface.position(graph.atNode(node)) - organ_.at(node)).norm(), 1e-15) << node;
    EXPECT_LT((surface.nodeNormal(node) - organ_.at(node).normalized()).norm(), 1e-12) << node;
  }
}

/// The integral of a quadratic shape function over a flat face: 0 at corners, a third of the face between them.
TEST_F(FacePoints, LoadsAreIntegralsOfShapeFunctions) {
  const double face = std::sqrt(3.0) / 2.0;
  const SurfaceGraph graph(organ_.positions, organ_.triangles, organ_.faces);
  const std::vector<double> loads = graph.loadAreas(), lumped = graph.lumpedAreas();
  for (std::size_t node = 0; node < loads.size(); ++node)
    EXPECT_NEAR(loads[node], node < 6 ? 0.0 : 2.0 * face / 3.0, 1e-14) << node;
  EXPECT_NEAR(std::accumulate(lumped.begin(), lumped.end(), 0.0), 8.0 * face, 1e-12);
  EXPECT_EQ(SurfaceGraph(organ_.positions, organ_.triangles).loadAreas(), lumped);
}

TEST_F(FacePoints, DistanceToNodesCountsTheMiddles) {
  const SurfaceMesh surface(view_);
  EXPECT_NEAR(surface.distanceToNodes(0, Vec3(0.5, 0.5, 0.1)), 0.1, 1e-15);
}

}  // namespace
}  // namespace palpate::testing
