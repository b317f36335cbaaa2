// SPDX-License-Identifier: Apache-2.0
#include "helpers.h"
#include "palpate/testing/paths.h"
#include "samples.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/read_mesh.h"

namespace palpate::mesh::test {
namespace {

TetMesh readVtk(const std::string& text) {
  const TemporaryFolder folder;
  return readMesh(folder.write("a.vtk", text));
}

void expectTwoUnnamedTetrahedra(const TetMesh& mesh) {
  EXPECT_EQ(mesh.node_tags, (std::vector<std::int64_t>{1, 2, 4, 5, 6}));
  ASSERT_EQ(mesh.tetrahedra.size(), 2U);
  EXPECT_EQ(mesh.tetrahedra[0], (std::array<std::int32_t, 4>{0, 1, 2, 3}));
  EXPECT_EQ(mesh.tetrahedra[1], (std::array<std::int32_t, 4>{1, 2, 3, 4}));
  EXPECT_EQ(mesh.nodes[4], Eigen::Vector3d(1, 1, 1));
  EXPECT_TRUE(mesh.groups.empty());
  EXPECT_NO_THROW(checkMesh(mesh));
}

// Numbers are big-endian in a binary file.
std::string binaryVtk() {
  std::string bytes =
      "# vtk DataFile Version 3.0\ntwo tetrahedra\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 float\n";
  for (const float x :
       {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 7.F, 7.F, 7.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 1.F, 1.F, 1.F}) {
    append(bytes, x, true);
  }
  bytes += "\nCELLS 3 14\n";
  for (const std::int32_t i : {3, 1, 3, 4, 4, 0, 1, 3, 4, 4, 1, 3, 4, 5}) append(bytes, i, true);
  bytes += "\nCELL_TYPES 3\n";
  for (const std::int32_t i : {5, 10, 10}) append(bytes, i, true);
  return bytes + "\n";
}

TEST(ReadVtk, Text) {
  const TetMesh mesh = readVtk(kVtk);
  expectTwoUnnamedTetrahedra(mesh);
  EXPECT_EQ(mesh.tetrahedron_tags, (std::vector<std::int64_t>{2, 3}));
}

TEST(ReadVtk, TextOfVersion5) {
  expectTwoUnnamedTetrahedra(readVtk(kVtk5));
}

TEST(ReadVtk, Binary) {
  expectTwoUnnamedTetrahedra(readVtk(binaryVtk()));
}

TEST(ReadVtk, RefusesOtherFilesAndDatasets) {
  EXPECT_REFUSED(readVtk("hello\nworld\n"), "not a legacy VTK file");
  EXPECT_REFUSED(readVtk(with(kVtk, "ASCII", "EBCDIC")), "line 3", "'EBCDIC'");
  EXPECT_REFUSED(readVtk(with(kVtk, "UNSTRUCTURED_GRID", "POLYDATA")), "line 4", "POLYDATA");
}

TEST(ReadVtk, RefusesACornerOutOfRange) {
  EXPECT_REFUSED(readVtk(with(kVtk, "4 1 3 4 5", "4 1 3 4 6")), "tetrahedron 3", "node 7");
  EXPECT_REFUSED(readVtk(with(kVtk, "4 1 3 4 5", "4 1 3 4 -9")), "tetrahedron 3", "node -8");
}

TEST(ReadVtk, RefusesOtherVolumeCells) {
  EXPECT_REFUSED(readVtk(with(kVtk, "5\n10\n10", "5\n10\n25")), "cell 3", "type 25");
  EXPECT_REFUSED(readVtk(with(kVtk, "5\n10\n10", "10\n10\n10")), "cell 1", "type 10 with 3 nodes");
  EXPECT_REFUSED(readVtk(with(kVtk, "5\n10\n10", "5\n10\n24")), "cell 3", "type 24 with 4 nodes");
}

// The middles of edges 01 12 02 03 13 23, in this order.
const std::string kQuadratic = R"(# vtk DataFile Version 3.0
one quadratic tetrahedron
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 11 float
0 0 0 1 0 0 0 1 0 0 0 1
0.5 0 0 0.5 0.5 0 0 0.5 0 0 0 0.5 0.5 0 0.5 0 0.5 0.5
1 1 1
CELLS 1 11
10 0 1 2 3 4 5 6 7 8 9
CELL_TYPES 1
24
)";

TEST(ReadVtk, QuadraticTetrahedra) {
  const TetMesh mesh = readVtk(kQuadratic);
  ASSERT_EQ(mesh.midsides.size(), 1U);
  EXPECT_EQ(mesh.midsides[0], (std::array<std::int32_t, 6>{4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(mesh.nodes.size(), 10U);  // the last belongs to nothing
  EXPECT_NO_THROW(checkMesh(mesh));
}

TEST(ReadVtk, RefusesTetrahedraOfFourAndOfTenNodesTogether) {
  const std::string mixed =
      with(with(kQuadratic, "CELLS 1 11", "CELLS 2 16\n4 1 3 2 10"), "TYPES 1", "TYPES 2\n10");
  EXPECT_REFUSED(readVtk(mixed), "tetrahedron 2 has 10 nodes, tetrahedron 1 has 4");
}

TEST(ReadVtk, RefusesCountsThatDoNotFit) {
  EXPECT_REFUSED(readVtk(with(kVtk, "POINTS 6", "POINTS 600000000")), "number of points is 600000000");
  EXPECT_REFUSED(readVtk(with(kVtk, "CELLS 3 14", "CELLS 3 15")), "14 numbers", "announces 15");
  EXPECT_REFUSED(readVtk(with(kVtk, "CELL_TYPES 3\n5", "CELL_TYPES 2\n")), "3 cells and 2 cell types");
  EXPECT_REFUSED(readVtk(with(kVtk5, "0 4 8", "0 4 9")), "offsets of cell 2");
  EXPECT_REFUSED(readVtk(with(kVtk, "1 1 double", "99999999 99999999 double")),
                 "number of components is 99999999");
  const std::string binary = binaryVtk();
  EXPECT_REFUSED(readVtk(binary.substr(0, binary.find("\nCELLS") - 5)),
                 "the file ends in a point's coordinate");
}

TEST(ReadVtk, RefusesTheBrokenLiverOfTheSofaFramework) {
  const std::filesystem::path file = palpate::testing::dataDir() + "/sofa-liver/liver_for_test_broken.vtk";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  EXPECT_REFUSED(readMesh(file), "liver_for_test_broken.vtk", "POLYDATA");
}

}  // namespace
}  // namespace palpate::mesh::test
