// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/write_vtk.h"

#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/read_mesh.h"
#include "tools/program/write_file.h"

namespace palpate::mesh::test {
namespace {

TEST(WriteVtk, ComesBackWithTheSameNodesAndElements) {
  const TemporaryFolder folder;
  for (const TetMesh& mesh : {makeBeam(), quadraticOf(makeBox({0.1, 0.2, 0.3}, {3, 4, 5}))}) {
    writeVtk(folder / "a.vtk", mesh);
    const TetMesh back = readMesh(folder / "a.vtk");
    EXPECT_EQ(back.nodes, mesh.nodes);
    EXPECT_EQ(back.tetrahedra, mesh.tetrahedra);
    EXPECT_EQ(back.midsides, mesh.midsides);
  }
}

TEST(WriteVtk, GroupsAndRegionsAreDataToLookAt) {
  const TemporaryFolder folder;
  TetMesh mesh = oneTetrahedron();
  mesh.groups["bare area"] = {1, 3};
  mesh.regions["nodule"] = {0};
  writeVtk(folder / "a.vtk", mesh);
  const std::string text = contentOf(folder / "a.vtk");
  EXPECT_NE(text.find("POINT_DATA 4\nSCALARS bare_area int 1\nLOOKUP_TABLE default\n0\n1\n0\n1\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("CELL_DATA 1\nSCALARS nodule int 1\nLOOKUP_TABLE default\n1\n"), std::string::npos)
      << text;
}

TEST(WriteVtk, RefusesAFolderThatIsNotThere) {
  const TemporaryFolder folder;
  EXPECT_THROW(writeVtk(folder / "none/a.vtk", oneTetrahedron()), program::WriteError);
}

}  // namespace
}  // namespace palpate::mesh::test
