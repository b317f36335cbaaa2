// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/eighths.h"

#include <algorithm>
#include <numeric>

#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/topology.h"

namespace palpate::mesh::test {
namespace {

double volumeOf(const TetMesh& mesh) {
  double volume = 0.0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) volume += signedVolume(mesh, t);
  return volume;
}

TEST(Eighths, OfABoxAreTheBoxAtHalfTheEdge) {
  TetMesh box = makeBox({1, 2, 3}, {3, 4, 5});
  for (Eigen::Vector3d& x : box.nodes) x.x() *= x.x();  // elements of different sizes; the box stays one
  std::vector<std::int32_t> all(box.tetrahedra.size());
  std::iota(all.begin(), all.end(), 0);
  const Eighths fine = eighthsOf(box, all);
  ASSERT_EQ(fine.mesh.tetrahedra.size(), 8 * box.tetrahedra.size());
  EXPECT_EQ(fine.mesh.nodes.size(), 5U * 7U * 9U);
  EXPECT_NEAR(volumeOf(fine.mesh), 6.0, 1e-12);
  EXPECT_NO_THROW(checkMesh(fine.mesh));
  for (std::size_t t = 0; t < fine.parent.size(); ++t)
    EXPECT_NEAR(signedVolume(fine.mesh, t), signedVolume(box, static_cast<std::size_t>(fine.parent[t])) / 8.0,
                1e-12);
}

TEST(Eighths, OfAPartFillThatPart) {
  const TetMesh box = makeBox({1, 2, 3}, {3, 4, 5});
  const std::vector<std::int32_t> some{3, 4, 17};
  const Eighths fine = eighthsOf(box, some);
  double volume = 0.0;
  for (const std::int32_t t : some) volume += signedVolume(box, static_cast<std::size_t>(t));
  EXPECT_NEAR(volumeOf(fine.mesh), volume, 1e-12);
  EXPECT_EQ(std::count(fine.parent.begin(), fine.parent.end(), 17), 8);
}

}  // namespace
}  // namespace palpate::mesh::test
