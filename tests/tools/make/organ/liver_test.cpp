// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/liver.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <vector>

#include "helpers.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/statistics.h"
#include "tools/mesh/topology.h"

namespace palpate::organ::test {
namespace {

using mesh::TetMesh;
using Vec3 = Eigen::Vector3d;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

Liver made(double surface, double inner, int order = 2) {
  LiverOptions options;
  options.sizes.surface = surface;
  options.sizes.inner = inner;
  options.order = order;
  return makeLiver(options);
}

const Liver& liver() {
  static const Liver made = makeLiver();
  return made;
}

const TetMesh& organ() {
  return liver().mesh;
}

const mesh::BoundarySurface& boundary() {
  static const mesh::BoundarySurface surface = mesh::boundaryOf(organ());
  return surface;
}

// Extents in y and z of the surface nodes within 4 mm of x.
Eigen::AlignedBox2d sliceAt(double x) {
  Eigen::AlignedBox2d box;
  for (const auto node : boundary().nodes) {
    const Vec3& at = organ().nodes[index(node)];
    if (std::abs(at.x() - x) < 0.004) box.extend(Eigen::Vector2d(at.y(), at.z()));
  }
  return box;
}

TEST(Liver, HasTheSizeOfALiver) {
  const mesh::MeshStatistics s = mesh::statisticsOf(organ(), boundary());
  const Vec3 size = s.box_max - s.box_min;
  EXPECT_NEAR(size.x(), 0.225, 0.003);
  EXPECT_NEAR(size.y(), 0.12, 0.01);
  EXPECT_NEAR(size.z(), 0.125, 0.01);
  EXPECT_NEAR(s.volume, 1.23e-3, 0.05e-3);  // livers of adults: 1.2 to 1.6 litres
}

TEST(Liver, HasAThickAndAFlatLobeWithNotchesBetween) {
  EXPECT_GT(sliceAt(-0.045).sizes().y(), 0.11);
  EXPECT_LT(sliceAt(0.09).sizes().y(), 0.05);
  const auto edge = [](double x) { return sliceAt(x).min().y(); };  // z of the inferior edge
  EXPECT_GT(edge(0.002), edge(-0.022) + 0.015);
  EXPECT_GT(edge(0.002), edge(0.018) + 0.003);  // the quadrate lobe hangs down between the notches
  EXPECT_GT(edge(0.043), edge(0.018) + 0.012);
}

TEST(Liver, HasAFlatUnderSide) {
  std::vector<Vec3> under;  // of the right lobe
  for (const auto node : boundary().nodes) {
    const Vec3& at = organ().nodes[index(node)];
    if (std::abs(at.x() + 0.045) < 0.015 && std::abs(at.y()) < 0.035 && at.z() < 0) under.push_back(at);
  }
  ASSERT_GT(under.size(), 50U);
  Eigen::MatrixXd basis(under.size(), 3);
  Eigen::VectorXd height(under.size());
  for (std::size_t i = 0; i < under.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    basis.row(row) << 1, under[i].x(), under[i].y();
    height[row] = under[i].z();
  }
  const Eigen::VectorXd plane = basis.colPivHouseholderQr().solve(height);
  EXPECT_LT((basis * plane - height).cwiseAbs().maxCoeff(), 0.005);
}

TEST(Liver, HasAThinEdge) {
  const double front = sliceAt(0.075).min().x();
  Eigen::AlignedBox1d behind;  // z, 10 mm behind the foremost point of the left lobe
  for (const auto node : boundary().nodes) {
    const Vec3& at = organ().nodes[index(node)];
    if (std::abs(at.x() - 0.075) < 0.006 && std::abs(at.y() - front - 0.010) < 0.004)
      behind.extend(Eigen::AlignedBox1d::VectorType(at.z()));
  }
  EXPECT_LT(behind.sizes()[0], 0.032);
  EXPECT_GT(behind.sizes()[0], 0.008);
}

TEST(Liver, IsASoundGradedMeshOfQuadraticElements) {
  EXPECT_NO_THROW(mesh::checkMesh(organ()));
  const mesh::MeshStatistics s = mesh::statisticsOf(organ(), boundary());
  EXPECT_TRUE(organ().isQuadratic());
  EXPECT_GT(s.worst_quality, 0.2);
  EXPECT_LE(s.surface_corners, 1500U);
  EXPECT_LE(s.nodes, 15000U);
  EXPECT_NEAR(s.median_surface_edge, 0.0075, 0.0003);
  const TetMesh even = made(0.008, 0.008, 1).mesh;
  EXPECT_GT(even.tetrahedra.size(), organ().tetrahedra.size() * 3 / 2);
}

TEST(Liver, IsMeshableFromFineToCoarse) {
  for (const double size : {0.010, 0.015, 0.020}) {
    const TetMesh mesh = made(size, std::min(2.5 * size, 0.03), 1).mesh;
    EXPECT_FALSE(mesh.isQuadratic());
    EXPECT_GT(mesh::statisticsOf(mesh, mesh::boundaryOf(mesh)).worst_quality, 0.05) << size;
  }
}

TEST(Liver, AllElementsAreOfOneTissue) {
  const auto& nodule = organ().regions.at("nodule");
  const auto& rest = organ().regions.at("liver");
  EXPECT_EQ(organ().regions.size(), 2U);
  std::set<std::int32_t> all(nodule.begin(), nodule.end());
  all.insert(rest.begin(), rest.end());
  EXPECT_EQ(all.size(), organ().tetrahedra.size());
  EXPECT_EQ(nodule.size() + rest.size(), organ().tetrahedra.size());
}

TEST(Liver, NoduleIsABallOfSmallElements) {
  const double r = Nodule::kRadius;
  double volume = 0, farthest = 0, edges = 0;
  std::size_t count = 0;
  for (const auto t : organ().regions.at("nodule")) {
    volume += mesh::signedVolume(organ(), index(t));
    const auto& corners = organ().tetrahedra[index(t)];
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3& a = organ().nodes[index(corners[i])];
      farthest = std::max(farthest, (a - liver().nodule.centre).norm());
      for (std::size_t j = 0; j < i; ++j, ++count) edges += (a - organ().nodes[index(corners[j])]).norm();
    }
  }
  EXPECT_NEAR(farthest, r, 1e-6);
  EXPECT_NEAR(volume / (4 * std::numbers::pi / 3 * r * r * r), 0.96, 0.03);
  EXPECT_LT(edges / static_cast<double>(count), 0.005);
}

TEST(Liver, NoduleLiesUnderAnAccessiblePlaceOfTheFront) {
  const Vec3& above = liver().nodule.above;
  EXPECT_LT(above.y(), -0.05);
  double nearest = 1, to_nodule = 1;
  const auto& accessible = organ().groups.at("accessible");
  for (const auto node : boundary().nodes) {
    const double distance = (organ().nodes[index(node)] - above).norm();
    nearest = std::min(nearest, distance);
    if (distance < 0.03) {
      EXPECT_TRUE(std::binary_search(accessible.begin(), accessible.end(), node));
    }
    to_nodule = std::min(to_nodule, (organ().nodes[index(node)] - liver().nodule.centre).norm());
  }
  EXPECT_LT(nearest, 0.005);
  EXPECT_NEAR(to_nodule, Nodule::kDepth, 0.0006);
}

TEST(Liver, IsHeldAtTheBack) {
  std::size_t held = 0;
  for (const auto node : organ().groups.at("fixed")) {
    EXPECT_GT(organ().nodes[index(node)].y(), 0.02);
    held += std::binary_search(boundary().nodes.begin(), boundary().nodes.end(), node) ? 1U : 0U;
  }
  EXPECT_EQ(held, organ().groups.at("fixed").size());
  const double share = static_cast<double>(held) / static_cast<double>(boundary().nodes.size());
  EXPECT_NEAR(share, 0.08, 0.02);
  EXPECT_NO_THROW(mesh::checkHeld(organ(), "fixed"));
}

TEST(Liver, AccessibleIsTheSurfaceAwayFromTheClamp) {
  const auto& accessible = organ().groups.at("accessible");
  for (const auto node : accessible) {
    EXPECT_TRUE(std::binary_search(boundary().nodes.begin(), boundary().nodes.end(), node));
    for (const auto held : organ().groups.at("fixed"))
      ASSERT_GT((organ().nodes[index(node)] - organ().nodes[index(held)]).norm(), 0.010);
  }
  EXPECT_GT(accessible.size(), boundary().nodes.size() * 3 / 4);
}

TEST(Liver, ComesOutTheSameEveryTime) {
  const TetMesh again = makeLiver().mesh;
  EXPECT_EQ(again.nodes, organ().nodes);
  EXPECT_EQ(again.tetrahedra, organ().tetrahedra);
  EXPECT_EQ(again.regions, organ().regions);
}

TEST(Liver, RefusesOptionsOutOfRange) {
  EXPECT_REFUSED(made(0.001, 0.02), "--element-size", "0.001");
  EXPECT_REFUSED(made(std::numeric_limits<double>::quiet_NaN(), 0.02), "--element-size", "nan");
  EXPECT_REFUSED(made(0.008, 0.007), "--inner-size", "0.007");
  EXPECT_REFUSED(made(0.008, 0.02, 3), "--element-order must be 1 or 2, not 3");
}

}  // namespace
}  // namespace palpate::organ::test
