// SPDX-License-Identifier: Apache-2.0
#include "core/data/region_surfaces.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "core/base/types.h"

namespace palpate {

namespace {

/// Tetrahedron 0 with one on each of its faces: 1 to 4, each of twice its volume. Node 0 is at the origin, the
/// tetrahedron's edges along the axes.
class Cluster {
 public:
  explicit Cluster(std::vector<std::int32_t> region_of) : region_(std::move(region_of)) {
    names_.assign(4, regionName("tissue"));
    tags_.assign(nodes_.size() / 3, 1);
  }

  [[nodiscard]] ModelView view() const {
    ModelView v;
    v.mesh_nodes = nodes_;
    v.mesh_node_tag = tags_;
    v.mesh_tetrahedra = tetrahedra;
    v.mesh_element_region = region_;
    v.region_name = names_;
    return v;
  }

  std::vector<std::int32_t> tetrahedra{0, 1, 2, 3, 1, 3, 2, 4, 0, 2, 3, 5, 0, 3, 1, 6, 0, 1, 2, 7};

 private:
  std::vector<double> nodes_{0, 0, 0, 1,  0, 0, 0, 1,  0, 0, 0, 1,  //
                             1, 1, 1, -2, 0, 0, 0, -2, 0, 0, 0, -2};
  std::vector<std::int64_t> tags_;
  std::vector<std::int32_t> region_;
  std::vector<RegionName> names_;
};

/// What a closed surface holds, m^3, by the divergence theorem; below 0 where it is turned inside out.
double volumeIn(const RegionSurface& surface) {
  const auto X = [&](std::size_t i) {
    return Eigen::Map<const Vec3>(surface.positions.data() + 3 * std::size_t{surface.triangles[i]});
  };
  double volume = 0.0;
  for (std::size_t i = 0; i < surface.triangles.size(); i += 3)
    volume += X(i).dot(X(i + 1).cross(X(i + 2))) / 6.0;
  return volume;
}

}  // namespace

TEST(RegionSurfaces, ANoduleHasAllItsFacesOutwardAndWhatItLiesInHasNone) {
  const Cluster cluster({1, 0, 0, 0, 0});
  const auto surfaces = regionSurfaces(cluster.view());
  ASSERT_EQ(surfaces.size(), 4U);
  EXPECT_EQ(surfaces[0].tetrahedra, 4U);
  EXPECT_TRUE(surfaces[0].triangles.empty());
  EXPECT_EQ(surfaces[1].tetrahedra, 1U);
  EXPECT_EQ(surfaces[1].triangles.size(), 12U);
  EXPECT_EQ(surfaces[1].positions.size(), 12U);
  EXPECT_NEAR(volumeIn(surfaces[1]), 1.0 / 6.0, 1e-12);
  EXPECT_EQ(surfaces[2].tetrahedra, 0U);
}

TEST(RegionSurfaces, CentreIsThatOfTheVolume) {
  const auto surfaces = regionSurfaces(Cluster({1, 0, 2, 2, 2}).view());
  EXPECT_LT((surfaces[1].centre - Vec3::Constant(0.25)).norm(), 1e-12);
  EXPECT_LT((surfaces[0].centre - Vec3::Constant(0.5)).norm(), 1e-12);
  EXPECT_LT((surfaces[2].centre - Vec3::Zero()).norm(), 1e-12);
  EXPECT_EQ(surfaces[3].centre, Vec3::Zero().eval()) << "without tetrahedra";
}

TEST(RegionSurfaces, AFaceBetweenTwoSmallOnesIsThereOnceWithTheSmaller) {
  const Cluster cluster({1, 0, 0, 0, 2});  // 2 has twice the volume of 1
  const auto surfaces = regionSurfaces(cluster.view());
  EXPECT_EQ(surfaces[1].triangles.size(), 12U);
  EXPECT_TRUE(surfaces[2].triangles.empty());  // its other faces are the organ's surface
}

TEST(RegionSurfaces, OneMaterialHasNone) {
  const Cluster cluster({2, 2, 2, 2, 2});
  for (const RegionSurface& surface : regionSurfaces(cluster.view())) EXPECT_TRUE(surface.triangles.empty());
  EXPECT_TRUE(regionSurfaces(ModelView{}).empty());
}

TEST(RegionSurfaces, DegenerateMeshesAreSurvived) {
  Cluster thrice({1, 0, 0, 0, 0});
  for (std::size_t k = 0; k < 4; ++k)
    thrice.tetrahedra[4 + k] = thrice.tetrahedra[8 + k] = thrice.tetrahedra[k];
  const auto surfaces = regionSurfaces(thrice.view());
  EXPECT_EQ(surfaces[1].triangles.size(), 0U) << "each face of tetrahedron 0 is there three or four times";
  Cluster point({1, 0, 0, 0, 0});
  point.tetrahedra.assign(20, 3);
  EXPECT_EQ(regionSurfaces(point.view())[1].tetrahedra, 1U);
}

}  // namespace palpate
