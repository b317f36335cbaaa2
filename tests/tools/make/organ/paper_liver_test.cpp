// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/paper_liver.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "helpers.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/statistics.h"
#include "tools/mesh/topology.h"

namespace palpate::organ::test {
namespace {

using mesh::TetMesh;

const TetMesh& paperLiver() {
  static const TetMesh mesh = makePaperLiver();
  return mesh;
}

TEST(PaperLiver, HasTheSizeAndResolutionOfTheDesign) {
  const mesh::MeshStatistics s = mesh::statisticsOf(paperLiver(), mesh::boundaryOf(paperLiver()));
  EXPECT_GE(s.surface_nodes, 1700U);
  EXPECT_LE(s.surface_nodes, 2300U);
  const Eigen::Vector3d size = s.box_max - s.box_min;
  EXPECT_NEAR(size.x(), 0.22, 0.01);
  EXPECT_NEAR(size.y(), 0.13, 0.01);
  EXPECT_NEAR(size.z(), 0.12, 0.01);
}

TEST(PaperLiver, IsASoundMeshWithoutSlivers) {
  EXPECT_NO_THROW(mesh::checkMesh(paperLiver()));
  EXPECT_GT(mesh::statisticsOf(paperLiver(), mesh::boundaryOf(paperLiver())).worst_quality, 0.2);
}

TEST(PaperLiver, HasNoSharpCrease) {
  const auto boundary = mesh::boundaryOf(paperLiver());
  std::map<std::pair<std::int32_t, std::int32_t>, Eigen::Vector3d>
      normals;  // by the edge as the triangle passes it
  for (const auto& t : boundary.triangles) {
    const auto at = [&](std::size_t i) -> const Eigen::Vector3d& {
      return paperLiver().nodes[static_cast<std::size_t>(boundary.nodes[static_cast<std::size_t>(t[i])])];
    };
    const Eigen::Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    for (std::size_t i = 0; i < 3; ++i) normals[{t[i], t[(i + 1) % 3]}] = normal;
  }
  const double cos_limit = std::cos(30 * 3.14159265358979 / 180);
  ASSERT_FALSE(normals.empty());
  for (const auto& [edge, normal] : normals)
    EXPECT_GT(normal.dot(normals.at({edge.second, edge.first})), cos_limit);
}

TEST(PaperLiver, IsHeldAtTheBackByOnePatch) {
  const auto boundary = mesh::boundaryOf(paperLiver());
  const auto& fixed = paperLiver().groups.at("fixed");
  const double share = static_cast<double>(fixed.size()) / static_cast<double>(boundary.nodes.size());
  EXPECT_GE(share, 0.08);
  EXPECT_LE(share, 0.12);
  for (const auto node : fixed) EXPECT_GT(paperLiver().nodes[static_cast<std::size_t>(node)].y(), 0);
  // Walk over the surface's edges from one fixed node to all others.
  std::set<std::int32_t> wanted(fixed.begin(), fixed.end());
  std::set<std::int32_t> reached{fixed.front()};
  for (std::size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const auto& t : boundary.triangles) {
      std::array<std::int32_t, 3> nodes{};
      for (std::size_t i = 0; i < 3; ++i) nodes[i] = boundary.nodes[static_cast<std::size_t>(t[i])];
      if (std::none_of(nodes.begin(), nodes.end(), [&](auto n) { return reached.contains(n); })) continue;
      for (const auto n : nodes) {
        if (wanted.contains(n)) reached.insert(n);
      }
    }
  }
  EXPECT_EQ(reached, wanted);
}

TEST(PaperLiver, AccessibleIsTheSurfaceAwayFromTheClamp) {
  const auto& accessible = paperLiver().groups.at("accessible");
  for (const auto node : mesh::boundaryOf(paperLiver()).nodes) {
    double distance = 1.0;
    for (const auto held : paperLiver().groups.at("fixed"))
      distance = std::min(distance, (paperLiver().nodes[static_cast<std::size_t>(node)] -
                                     paperLiver().nodes[static_cast<std::size_t>(held)])
                                        .norm());
    EXPECT_EQ(std::binary_search(accessible.begin(), accessible.end(), node), distance >= 0.015) << node;
  }
}

TEST(PaperLiver, ComesOutTheSameEveryTime) {
  const TetMesh again = makePaperLiver();
  EXPECT_EQ(again.nodes, paperLiver().nodes);
  EXPECT_EQ(again.tetrahedra, paperLiver().tetrahedra);
}

TEST(PaperLiver, GrowsFinerWithTheElementSize) {
  const TetMesh coarse = makePaperLiver(0.012);
  EXPECT_NO_THROW(mesh::checkMesh(coarse));
  EXPECT_LT(coarse.nodes.size(), paperLiver().nodes.size() / 2);
}

TEST(PaperLiver, RefusesAnElementSizeOutOfRange) {
  EXPECT_REFUSED(makePaperLiver(0.001), "--element-size", "0.001");
  EXPECT_REFUSED(makePaperLiver(0.0 / 0.0), "--element-size", "nan");
}

}  // namespace
}  // namespace palpate::organ::test
