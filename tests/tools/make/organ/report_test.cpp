// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tools/mesh/box_mesh.h"
#include "tools/mesh/topology.h"

namespace palpate::organ::test {
namespace {

/// A box whose second slab of three is twice as long as the others. The region is the first and the second.
TEST(Report, ARegionHasItsCentreOfVolumeAndTheSurfaceNodeNearestToIt) {
  mesh::TetMesh box = mesh::makeBox({0.3, 0.2, 0.1}, {4, 3, 2});
  std::vector<std::int32_t>& region = box.regions["two"];
  for (std::size_t t = 0; t < box.tetrahedra.size(); ++t) {
    double x = 0.0;
    for (const std::int32_t corner : box.tetrahedra[t])
      x += 0.25 * box.nodes[static_cast<std::size_t>(corner)].x();
    if (x < 0.2) region.push_back(static_cast<std::int32_t>(t));
  }
  for (auto& node : box.nodes)
    if (node.x() > 0.15) node.x() += 0.1;
  const Report report = makeReport("box.msh", box, mesh::boundaryOf(box), {});
  const RegionReport& two = report.regions.at("two");
  EXPECT_EQ(two.tetrahedra, region.size());
  EXPECT_NEAR(two.volume, 0.3 * 0.2 * 0.1, 1e-15);
  EXPECT_NEAR((two.centre - Eigen::Vector3d(0.15, 0.1, 0.05)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(two.surface.x(), 0.1, 1e-15);
  EXPECT_NEAR(two.surface.y(), 0.1, 1e-15);
  EXPECT_NEAR((two.surface - two.centre).norm(), std::sqrt(0.005), 1e-15);
  const program::Json json = toJson(report).at("regions").at("two");
  EXPECT_EQ(json.at("centre")[0].get<double>(), two.centre.x());
  EXPECT_EQ(json.at("nearest_surface")[2].get<double>(), two.surface.z());
  std::ostringstream text;
  print(text, report);
  EXPECT_NE(text.str().find(
                " tetrahedra, centre 0.1500 0.1000 0.0500 m, 70.7 mm from the surface at 0.1000 0.1000 "),
            std::string::npos)
      << text.str();
}

}  // namespace
}  // namespace palpate::organ::test
