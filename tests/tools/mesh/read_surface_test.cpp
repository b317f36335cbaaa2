// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/read_surface.h"

#include <sstream>

#include "helpers.h"
#include "palpate/testing/paths.h"
#include "tools/mesh/surface_defects.h"

namespace palpate::mesh::test {
namespace {

TriangleSurface readText(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  return readSurface(folder.write(name, text));
}

std::string binaryStl(const std::string& head) {
  const TriangleSurface surface = cube();
  std::string bytes = head;
  bytes.resize(80, ' ');
  append(bytes, static_cast<std::uint32_t>(surface.triangles.size()));
  for (const auto& t : surface.triangles) {
    for (int i = 0; i < 3; ++i) append(bytes, 0.F);
    for (const auto v : t) {
      for (const double x : surface.vertices[static_cast<std::size_t>(v)])
        append(bytes, static_cast<float>(x));
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

std::string textStl() {
  std::ostringstream out;
  out << "solid a cube of mine\n";
  const TriangleSurface surface = cube();
  for (const auto& t : surface.triangles) {
    out << " facet normal 0 0 0\n  outer loop\n";
    for (const auto v : t)
      out << "   vertex " << surface.vertices[static_cast<std::size_t>(v)].transpose() << '\n';
    out << "  endloop\n endfacet\n";
  }
  out << "endsolid a cube of mine\n";
  return out.str();
}

// Quads, relative numbers, textures, normals, groups, comments and an unused vertex.
const std::string kObjCube = R"(# a cube
mtllib cube.mtl
o cube
v 9 9 9
v 0 0 0
v 1 0 0 # second
v 0 1 0
v 1 1 0
v 0 0 1 1.0
v 1 0 1
v 0 1 1
v 1 1 1
vt 0 0
vn 0 0 1
g sides
s off
f 2 4 5 3
f 6//1 7//1 9//1 8//1
f 2/1 3/1 7/1 6/1
f -6/1/1 -2/1/1 -1/1/1 -5/1/1
f 2 6 8 4
f 3 5 9 7
)";

TEST(ReadStl, JoinsTheCornersOfTextAndBinaryFacets) {
  for (const std::string& bytes : {textStl(), binaryStl("made by a test"), binaryStl("solid, but binary")}) {
    TriangleSurface surface = readText("a.STL", bytes);
    EXPECT_EQ(surface.vertices.size(), 8U);
    EXPECT_EQ(surface.triangles.size(), 12U);
    EXPECT_NO_THROW(checkSurface(surface));
  }
}

TEST(ReadStl, RefusesDamage) {
  EXPECT_REFUSED(readText("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n"), "line 4",
                 "'zero'");
  EXPECT_REFUSED(readText("a.stl", "solid\nfacet normal 0 0 1\nouter lap\n"), "line 3", "expected 'loop'");
  EXPECT_REFUSED(readText("a.stl", "solid nothing\nendsolid\n"), "holds no triangles");
  EXPECT_REFUSED(readText("a.stl", binaryStl("cut").substr(0, 300)), "number of facets is 12",
                 "216 bytes follow instead of 600");
  EXPECT_REFUSED(readText("a.stl", "short"), "the file ends in the head of a binary STL");
}

TEST(ReadObj, FansPolygonsAndSkipsTheRest) {
  TriangleSurface surface = readText("a.obj", kObjCube);
  EXPECT_EQ(surface.vertices.size(), 8U);
  EXPECT_EQ(surface.vertex_tags.front(), 2);
  EXPECT_EQ(surface.triangles.size(), 12U);
  EXPECT_EQ(surface.triangle_tags.back(), 6);
  EXPECT_NO_THROW(checkSurface(surface));
}

TEST(ReadObj, KeepsGroupsAndMaterialsOfTrianglesAsGroups) {
  const TriangleSurface surface = readText("a.obj",
                                           "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\n"
                                           "f 1 2 3\n"
                                           "g left rim\nusemtl skin\nf 1 2 3 4\n"
                                           "usemtl rim\r\nf 2 3 4\n"
                                           "g\nf 3 4 5\n"
                                           "g nothing\n");
  using Triangles = std::vector<std::int32_t>;
  const std::map<std::string, Triangles> expected{
      {"left", {1, 2, 3}}, {"rim", {1, 2, 3, 4}}, {"skin", {1, 2}}};
  EXPECT_EQ(surface.groups, expected);
  EXPECT_EQ(readText("a.obj", kObjCube).groups.at("sides").size(), 12U);
  std::string many = "v 0 0 0\ng";
  for (int i = 0; i < 17; ++i) many += " g" + std::to_string(i);
  EXPECT_REFUSED(readText("a.obj", many + "\n"), "line 2", "face 1 is in 17 groups, expected at most 16");
}

TEST(ReadObj, RefusesDamage) {
  EXPECT_REFUSED(readText("a.obj", "v 0 0\n"), "line 1", "vertex 1");
  EXPECT_REFUSED(readText("a.obj", "v 0 0 0\nf 1 1 2\n"), "line 2", "face 1 refers to vertex 2");
  EXPECT_REFUSED(readText("a.obj", "v 0 0 0\nf 1 1 0\n"), "face 1 refers to vertex 0");
  EXPECT_REFUSED(readText("a.obj", "v 0 0 0\nf 1 1 -2\n"), "face 1 refers to vertex -2");
  EXPECT_REFUSED(readText("a.obj", "v 0 0 0\nf 1 1 x\n"), "face 1 has a corner that is not a number");
  EXPECT_REFUSED(readText("a.obj", "v 0 0 0\nf 1 1\n"), "face 1 has 2 corners");
  EXPECT_REFUSED(readText("a.obj", "v 0 0 0\n"), "holds no triangles");
  EXPECT_REFUSED(readText("a.obj", std::string("\0\1\2\xff", 4)), "not a text OBJ file");
}

TEST(ReadSurface, KnowsItsFilesByExtension) {
  EXPECT_TRUE(isSurfaceFile("a.OBJ"));
  EXPECT_FALSE(isSurfaceFile("a.msh"));
  EXPECT_REFUSED(readText("a.msh", kObjCube), "'.msh'", ".stl, .obj");
}

TEST(ReadSurface, FindsTheSelfIntersectionOfTheSmoothLiver) {
  const std::filesystem::path file = palpate::testing::dataDir() + "/sofa-liver/liver-smooth.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  TriangleSurface surface = readSurface(file);
  EXPECT_EQ(surface.triangles.size(), 4384U);
  EXPECT_REFUSED(checkSurface(surface), "triangle", "intersect");
}

}  // namespace
}  // namespace palpate::mesh::test
