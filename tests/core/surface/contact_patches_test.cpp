// SPDX-License-Identifier: Apache-2.0
#include "core/surface/contact_patches.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

#include "core/base/index.h"

namespace palpate {
namespace {

constexpr double kWidth = 0.012;  // a, m

/// A square of 40 x 40 cells of 4 mm, bent over x = 0.08 m by an angle; node (i, j) is 41 i + j.
class Sheet {
 public:
  explicit Sheet(double angle) {
    constexpr int kCells = 40;
    for (int i = 0; i <= kCells; ++i)
      for (int j = 0; j <= kCells; ++j) {
        const double x = 0.004 * i, y = 0.004 * j + 1e-4 * std::sin(3.0 * i);
        const double beyond = std::max(0.0, x - 0.08);
        positions.insert(positions.end(),
                         {x - beyond * (1.0 - std::cos(angle)), y, beyond * std::sin(angle)});
      }
    for (std::int32_t i = 0; i < kCells; ++i)
      for (std::int32_t j = 0; j < kCells; ++j) {
        const std::int32_t a = 41 * i + j, b = a + 41;
        triangles.insert(triangles.end(), {a, b, b + 1, a, b + 1, a + 1});
      }
    free.assign(positions.size() / 3, 1);
    nodes.resize(free.size());
    std::iota(nodes.begin(), nodes.end(), 0);
  }
  [[nodiscard]] SurfaceGraph graph() const { return {positions, triangles}; }
  [[nodiscard]] Vec3 at(const ContactPoint& s) const {
    Vec3 x = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      x += s.barycentric[k] *
           Eigen::Map<const Vec3>(positions.data() + 3 * index(triangles[3 * index(s.triangle) + k]));
    return x;
  }
  std::vector<double> positions;
  std::vector<std::int32_t> triangles;
  std::vector<std::uint8_t> free;
  std::vector<std::int32_t> nodes;
};

const ContactPoint kMiddle{2 * (40 * 17 + 20), {0.2, 0.5, 0.3}};

std::vector<double> weightsByNode(const ContactPatches& patches, const ContactPoint& s, std::size_t nodes) {
  PatchNodes patch = patches.room();
  patches.at(s, false, patch);
  std::vector<double> weight(nodes, 0.0);
  for (std::size_t i = 0; i < patch.count; ++i) weight[index(patch.node[i])] = patch.weight[i];
  return weight;
}

TEST(ContactPatches, WeightsOnAPlaneAreTheTaperedGaussianOfTheStraightDistance) {
  const Sheet sheet(0.0);
  const SurfaceGraph graph = sheet.graph();
  const ContactPatches patches(graph, sheet.free, kWidth, sheet.nodes);
  const std::vector<double> area = graph.lumpedAreas();
  std::vector<double> expected(sheet.nodes.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double r = (Eigen::Map<const Vec3>(sheet.positions.data() + 3 * i) - sheet.at(kMiddle)).norm();
    const double x = r / (3.0 * kWidth), z = std::clamp((x - 0.6) / 0.4, 0.0, 1.0);
    const double taper = 1.0 - std::pow(z, 3) * (10.0 - 15.0 * z + 6.0 * z * z);
    expected[i] = area[i] * std::exp(-0.5 * r * r / (kWidth * kWidth)) * taper;
    sum += expected[i];
  }
  const std::vector<double> found = weightsByNode(patches, kMiddle, expected.size());
  ASSERT_GT(std::count_if(found.begin(), found.end(), [](double w) { return w > 0.0; }), 150);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i], expected[i] / sum, 2e-5) << i;
}

TEST(ContactPatches, WeightsAreContinuousOverAnEdgeThatBends) {
  const Sheet sheet(1.0);
  const ContactPatches patches(sheet.graph(), sheet.free, kWidth, sheet.nodes);
  const std::int32_t cell = 40 * 19 + 20;  // beside the bend
  const ContactPoint before{2 * cell, {0.4, 0.0, 0.6}}, after{2 * cell + 1, {0.4, 0.6, 0.0}};
  ASSERT_LT((sheet.at(before) - sheet.at(after)).norm(), 1e-15);
  const auto a = weightsByNode(patches, before, sheet.nodes.size());
  const auto b = weightsByNode(patches, after, sheet.nodes.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-14) << i;
}

TEST(ContactPatches, SlopesAreTheDerivativesOfTheWeights) {
  const Sheet sheet(0.7);
  const ContactPatches patches(sheet.graph(), sheet.free, kWidth, sheet.nodes);
  const ContactPoint s{2 * (40 * 19 + 20), {0.2, 0.5, 0.3}};
  PatchNodes patch = patches.room();
  patches.at(s, true, patch);
  ASSERT_GT(patch.count, 100U);
  constexpr double kStep = 1e-5;
  for (std::size_t k = 0; k < 2; ++k) {
    ContactPoint ahead = s, behind = s;
    ahead.barycentric[k] += kStep, ahead.barycentric[2] -= kStep;
    behind.barycentric[k] -= kStep, behind.barycentric[2] += kStep;
    const auto next = weightsByNode(patches, ahead, sheet.nodes.size());
    const auto last = weightsByNode(patches, behind, sheet.nodes.size());
    for (std::size_t i = 0; i < patch.count; ++i) {
      const std::size_t node = index(patch.node[i]);
      const double slope = patch.slope[i][Eigen::Index(k)] - patch.slope[i][2];
      EXPECT_NEAR((next[node] - last[node]) / (2.0 * kStep), slope, 1e-6) << node;
    }
  }
}

TEST(ContactPatches, LeavesOutClampedNodesAndSaysHowMuchTheyWere) {
  Sheet sheet(0.0);
  for (std::size_t i = 0; i < sheet.free.size(); ++i) sheet.free[i] = i % 41 < 20 ? 0 : 1;
  const ContactPatches patches(sheet.graph(), sheet.free, kWidth, sheet.nodes);
  PatchNodes patch = patches.room();
  patches.at(kMiddle, false, patch);
  double sum = 0.0;
  for (std::size_t i = 0; i < patch.count; ++i) {
    EXPECT_EQ(sheet.free[index(patch.node[i])], 1);
    sum += patch.weight[i];
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_GT(patch.free_share, 0.5);
  EXPECT_LT(patch.free_share, 0.65);
}

// Of quadratic elements the corners of faces carry no load (docs/design.md, Elements), and lists have no room for them.
TEST(ContactPatches, ListsHoldMiddlesOnlyWhereCornersCarryNothing) {
  constexpr std::int32_t kCells = 24, kRow = 2 * kCells + 1;
  const auto node = [](std::int32_t i, std::int32_t j) { return kRow * i + j; };
  std::vector<double> positions;
  for (std::int32_t i = 0; i < kRow; ++i)
    for (std::int32_t j = 0; j < kRow; ++j) positions.insert(positions.end(), {0.003 * i, 0.003 * j, 0.0});
  std::vector<std::int32_t> triangles, faces, centres;
  const auto add = [&](std::array<std::int32_t, 2> A, std::array<std::int32_t, 2> B,
                       std::array<std::int32_t, 2> C) {
    const auto middle = [&](const auto& one, const auto& other) {
      return node((one[0] + other[0]) / 2, (one[1] + other[1]) / 2);
    };
    const std::int32_t a = node(A[0], A[1]), b = node(B[0], B[1]), c = node(C[0], C[1]);
    const std::int32_t ab = middle(A, B), bc = middle(B, C), ca = middle(C, A);
    faces.insert(faces.end(), {a, b, c});
    triangles.insert(triangles.end(), {a, ab, ca, ab, b, bc, ca, bc, c, bc, ca, ab});
  };
  for (std::int32_t i = 0; i < kRow - 1; i += 2)
    for (std::int32_t j = 0; j < kRow - 1; j += 2) {
      add({i, j}, {i + 2, j}, {i + 2, j + 2});
      add({i, j}, {i + 2, j + 2}, {i, j + 2});
    }
  for (std::int32_t i = 0; i < kRow; i += 2)
    for (std::int32_t j = 0; j < kRow; j += 2) centres.push_back(node(i, j));
  const SurfaceGraph graph(positions, triangles, faces);
  const std::vector<std::uint8_t> free(positions.size() / 3, 1);
  const ContactPatches patches(graph, free, kWidth, centres);

  SurfaceFront front(graph);
  std::size_t middles = 0;
  for (const std::int32_t centre : centres) {
    ContactPoint s{graph.trianglesOf(centre).front(), {}};
    for (std::size_t k = 0; k < 3; ++k)
      s.barycentric[k] = graph.triangle(s.triangle)[k] == centre ? 1.0 : 0.0;
    const double longest =
        centre == node(0, kRow - 1) || centre == node(kRow - 1, 0) ? 0.006 : 0.006 * std::sqrt(2.0);
    for (const auto& [reached, distance] : front.from(s, 3.0 * kWidth + longest))
      middles += (reached / kRow) % 2 != 0 || (reached % kRow) % 2 != 0 ? 1 : 0;
  }
  EXPECT_GT(middles, 100 * centres.size());
  EXPECT_EQ(patches.entries(), middles);
  PatchNodes patch = patches.room();
  patches.at({kCells * kCells, {0.3, 0.3, 0.4}}, false, patch);
  EXPECT_GT(patch.count, 100U);
  for (std::size_t i = 0; i < patch.count; ++i)
    EXPECT_TRUE((patch.node[i] / kRow) % 2 != 0 || (patch.node[i] % kRow) % 2 != 0) << patch.node[i];
}

}  // namespace
}  // namespace palpate
