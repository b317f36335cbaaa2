// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/fill_surface.h"

#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/topology.h"

namespace palpate::mesh::test {
namespace {

double volumeOf(const TetMesh& mesh) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) volume += signedVolume(mesh, t);
  return volume;
}

TEST(FillSurface, KeepsTheTrianglesOfACube) {
  const TriangleSurface surface = cube();
  const TetMesh mesh = fillSurface(surface, 0);
  EXPECT_NO_THROW(checkMesh(mesh));
  EXPECT_NEAR(volumeOf(mesh), 1, 1e-12);
  EXPECT_EQ(boundaryOf(mesh).triangles.size(), 12U);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(mesh.nodes[i], surface.vertices[i]);
}

TEST(FillSurface, RemeshesACubeAtTheGivenSize) {
  const TetMesh coarse = fillSurface(cube(), 0.5);
  const TetMesh fine = fillSurface(cube(), 0.2);
  EXPECT_NO_THROW(checkMesh(fine));
  EXPECT_NEAR(volumeOf(fine), 1, 1e-9);
  EXPECT_GT(boundaryOf(fine).triangles.size(), 4 * boundaryOf(coarse).triangles.size());
}

TEST(FillSurface, MakesAFineSurfaceCoarser) {
  const TetMesh box = makeBox({1, 1, 1}, {13, 13, 13});
  const BoundarySurface boundary = boundaryOf(box);
  TriangleSurface surface;
  for (const auto node : boundary.nodes)
    surface.vertices.push_back(box.nodes[static_cast<std::size_t>(node)]);
  surface.triangles = boundary.triangles;
  const TetMesh mesh = fillSurface(surface, 0.3);
  EXPECT_NO_THROW(checkMesh(mesh));
  EXPECT_NEAR(volumeOf(mesh), 1, 1e-9);
  EXPECT_LT(boundaryOf(mesh).triangles.size(), surface.triangles.size() / 4);
}

TEST(FillSurface, RefusesANegativeSize) {
  EXPECT_REFUSED(fillSurface(cube(), -1), "element size");
}

}  // namespace
}  // namespace palpate::mesh::test
