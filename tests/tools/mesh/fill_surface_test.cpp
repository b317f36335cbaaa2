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
  const TetMesh mesh = fillSurface(surface, {0});
  EXPECT_NO_THROW(checkMesh(mesh));
  EXPECT_NEAR(volumeOf(mesh), 1, 1e-12);
  EXPECT_EQ(boundaryOf(mesh).triangles.size(), 12U);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(mesh.nodes[i], surface.vertices[i]);
}

TEST(FillSurface, RemeshesACubeAtTheGivenSize) {
  const TetMesh coarse = fillSurface(cube(), {0.5});
  const TetMesh fine = fillSurface(cube(), {0.2});
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
  const TetMesh mesh = fillSurface(surface, {0.3});
  EXPECT_NO_THROW(checkMesh(mesh));
  EXPECT_NEAR(volumeOf(mesh), 1, 1e-9);
  EXPECT_LT(boundaryOf(mesh).triangles.size(), surface.triangles.size() / 4);
}

// Interior elements of a large cube grow; its surface is the same.
TEST(FillSurface, GrowsInsideWhetherTheSurfaceIsKeptOrRemeshed) {
  const TetMesh box = makeBox({1, 1, 1}, {11, 11, 11});
  const BoundarySurface boundary = boundaryOf(box);
  TriangleSurface surface;
  for (const auto node : boundary.nodes)
    surface.vertices.push_back(box.nodes[static_cast<std::size_t>(node)]);
  surface.triangles = boundary.triangles;
  for (const double size : {0.0, 0.1}) {
    const TetMesh even = fillSurface(surface, {size});
    const TetMesh graded = fillSurface(surface, {size, 0.4, 0.5});
    EXPECT_NO_THROW(checkMesh(graded));
    EXPECT_NEAR(volumeOf(graded), 1, 1e-9);
    const auto triangles = static_cast<double>(boundaryOf(even).triangles.size());
    EXPECT_NEAR(static_cast<double>(boundaryOf(graded).triangles.size()) / triangles, 1, size > 0 ? 0.05 : 0);
    const auto inner = [](const TetMesh& mesh) { return mesh.nodes.size() - boundaryOf(mesh).nodes.size(); };
    EXPECT_LT(inner(graded), 200U) << size;
    EXPECT_GT(inner(graded), 20U) << size;
    const TetMesh steep = fillSurface(surface, {size, 0.4, 1});
    EXPECT_LT(inner(steep), inner(graded)) << size;
  }
}

// Whether the surface is kept or remeshed.
TEST(FillSurface, LeavesCavitiesEmpty) {
  TriangleSurface hollow = cube();
  for (const double shift : {0.1, 0.6}) {
    const auto offset = static_cast<std::int32_t>(hollow.vertices.size());
    for (const auto& x : cube().vertices)
      hollow.vertices.emplace_back(0.25 * x + Eigen::Vector3d::Constant(shift));
    for (const auto& t : cube().triangles)
      hollow.triangles.push_back({t[0] + offset, t[2] + offset, t[1] + offset});
  }
  for (const double size : {0.0, 0.15}) {
    const TetMesh mesh = fillSurface(hollow, {size});
    EXPECT_NO_THROW(checkMesh(mesh));
    EXPECT_NEAR(volumeOf(mesh), 1 - 2.0 / 64, 1e-9) << size;
  }
}

TEST(FillSurface, RefusesANegativeSize) {
  EXPECT_REFUSED(fillSurface(cube(), {-1}), "--element-size");
  EXPECT_REFUSED(fillSurface(cube(), {0.2, 0.1}), "--inner-size must be at least --element-size");
  EXPECT_REFUSED(fillSurface(cube(), {0.2, 0.4, 3}), "--growth", "3.0");
}

}  // namespace
}  // namespace palpate::mesh::test
