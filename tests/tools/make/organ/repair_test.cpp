// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "helpers.h"
#include "palpate/testing/paths.h"
#include "spoiled_sphere.h"
#include "tools/make/organ/repair/repair_surface.h"
#include "tools/mesh/read_surface.h"
#include "tools/mesh/surface_defects.h"
#include "tools/mesh/surface_solids.h"

namespace palpate::organ::test {
namespace {

using mesh::enclosedVolume;

constexpr double kBallRadius = 0.05;  // m

TEST(RepairSurface, ASpoiledSphereHasTheVolumeOfTheSoundOne) {
  const mesh::TriangleSurface spoiled = spoiledSphere(kBallRadius, 5);
  ASSERT_FALSE(mesh::surfaceDefects(spoiled).empty());
  Repairs repairs;
  const mesh::TriangleSurface whole = repairSurface(spoiled, repairs);
  EXPECT_TRUE(mesh::surfaceDefects(whole).empty());
  EXPECT_EQ(mesh::solidsOf(whole).size(), 1U);
  const double sound = enclosedVolume(sphere(kBallRadius, 5));
  EXPECT_NEAR(enclosedVolume(whole) / sound, 1, 0.01);
  EXPECT_EQ(repairs.volume_after, enclosedVolume(whole));
}

TEST(RepairSurface, CountsWhatItChanged) {
  Repairs repairs;
  (void)repairSurface(spoiledSphere(kBallRadius, 5), repairs);
  EXPECT_GE(repairs.crossing_pairs, 20U);
  EXPECT_EQ(repairs.holes, 2U);
  EXPECT_EQ(repairs.twins, 3U);
  EXPECT_EQ(repairs.flat, 1U);
  EXPECT_EQ(repairs.loose.size(), 10U);
  // One of the holes lies in a part that is turned over; which way a loose triangle faces says nothing.
  mesh::TriangleSurface cut = sphere(kBallRadius, 5);
  cutHole(cut, {0.2, 0.1, 1}, 2 * 1.6 * kBallRadius / 32);
  const auto turned = std::count_if(cut.triangles.begin(), cut.triangles.end(), [&](const auto& t) {
    const Eigen::Vector3d x = centreOf(cut, t);
    return x.z() > 0.8 * kBallRadius || x.dot(Eigen::Vector3d(-0.6, 0.8, 0)) > 0.7 * kBallRadius;
  });
  EXPECT_NEAR(static_cast<double>(repairs.turned_over), static_cast<double>(turned), 10);
  std::string words;
  for (const auto& line : repairs.inWords()) words += line + '\n';
  for (const char* part :
       {"10 loose pieces left out: 1 triangle, ", "2 holes filled", "triangles turned over",
        "pairs of triangles crossed", "3 triangles left out that were there twice", "m^3 after"})
    EXPECT_NE(words.find(part), std::string::npos) << words;
}

TEST(RepairSurface, ASoundSurfaceStaysAsItIs) {
  const mesh::TriangleSurface sound = sphere(kBallRadius, 3);
  Repairs repairs;
  const mesh::TriangleSurface same = repairSurface(sound, repairs);
  const auto sorted = [](std::vector<Eigen::Vector3d> points) {
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    });
    return points;
  };
  EXPECT_EQ(sorted(same.vertices), sorted(sound.vertices));
  EXPECT_EQ(same.triangles.size(), sound.triangles.size());
  EXPECT_EQ(repairs.inWords().front(), "nothing to repair");
}

TEST(RepairSurface, TurnsAnInwardSurfaceOver) {
  mesh::TriangleSurface inward = sphere(kBallRadius, 3);
  for (auto& t : inward.triangles) std::swap(t[0], t[1]);
  Repairs repairs;
  EXPECT_GT(enclosedVolume(repairSurface(inward, repairs)), 0);
  EXPECT_EQ(repairs.turned_over, inward.triangles.size());
}

// As when each facet was rounded by itself.
TEST(RepairSurface, MergesVerticesThatNearlyCoincide) {
  const mesh::TriangleSurface sound = sphere(kBallRadius, 3);
  mesh::TriangleSurface soup;
  for (std::size_t t = 0; t < sound.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      soup.triangles.resize(t + 1);
      soup.triangles[t][k] = static_cast<std::int32_t>(soup.vertices.size());
      const double off = 1e-8 * kBallRadius * static_cast<double>((7 * t + k) % 5);
      soup.vertices.emplace_back(sound.vertices[static_cast<std::size_t>(sound.triangles[t][k])] +
                                 Eigen::Vector3d::Constant(off));
    }
  }
  numberFromOne(soup);
  Repairs repairs;
  const mesh::TriangleSurface whole = repairSurface(soup, repairs);
  EXPECT_EQ(whole.vertices.size(), sound.vertices.size());
  EXPECT_EQ(repairs.merged, soup.vertices.size() - sound.vertices.size());
  EXPECT_NEAR(enclosedVolume(whole) / enclosedVolume(sound), 1, 1e-6);
}

TEST(RepairSurface, RefusesAHoleThatIsTooLargeByItsPlaceAndSize) {
  mesh::TriangleSurface open = sphere(kBallRadius, 4);
  cutHole(open, {0, 0, 1}, 1.2 * kBallRadius);
  Repairs repairs;
  EXPECT_REFUSED(repairSurface(open, repairs), "the hole at (", "spans 0.1", "25 %");
}

// Five unstitched patches are no body with loose pieces beside it.
TEST(RepairSurface, KeepsPiecesThatAreMuchOfTheWhole) {
  mesh::TriangleSurface patches = sphere(kBallRadius, 3);
  mesh::TriangleSurface apart;
  for (const auto& t : patches.triangles) {
    const Eigen::Vector3d x = centreOf(patches, t);
    const double turn = std::atan2(x.y(), x.x());
    const auto patch = std::floor(5 * (turn + std::numbers::pi) / (2 * std::numbers::pi));
    const Eigen::Vector3d shift = 0.1 * kBallRadius * patch * Eigen::Vector3d::UnitZ();
    const auto first = static_cast<std::int32_t>(apart.vertices.size());
    for (const auto v : t) apart.vertices.push_back(patches.vertices[static_cast<std::size_t>(v)] + shift);
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  numberFromOne(apart);
  Repairs repairs;
  EXPECT_REFUSED(repairSurface(apart, repairs), "the hole at (", "that --repair fills");
  EXPECT_TRUE(repairs.loose.empty());
}

TEST(RepairSurface, KeepsACavity) {
  mesh::TriangleSurface hollow = sphere(kBallRadius, 4);
  const mesh::TriangleSurface inner = sphere(0.4 * kBallRadius, 3);
  const auto offset = static_cast<std::int32_t>(hollow.vertices.size());
  hollow.vertices.insert(hollow.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  for (const auto& t : inner.triangles)
    hollow.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  numberFromOne(hollow);
  cutHole(hollow, {1, 0, 0}, 0.3 * kBallRadius);
  Repairs repairs;
  const auto solids = mesh::solidsOf(repairSurface(hollow, repairs));
  ASSERT_EQ(solids.size(), 1U);
  EXPECT_EQ(solids[0].cavities.size(), 1U);
}

TEST(RepairSurface, TheSmoothLiverOfTheSofaFrameworkBecomesSound) {
  const std::string file = palpate::testing::dataDir() + "/sofa-liver/liver-smooth.obj";
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << file << " is not there: shared data is not part of the repository";
  Repairs repairs;
  const mesh::TriangleSurface whole = repairSurface(mesh::readSurface(file), repairs);
  EXPECT_GT(repairs.crossing_pairs, 0U);
  EXPECT_TRUE(mesh::surfaceDefects(whole).empty());
  EXPECT_NEAR(repairs.volume_after / repairs.volume_before, 1, 0.01);
}

}  // namespace
}  // namespace palpate::organ::test
