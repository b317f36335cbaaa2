// SPDX-License-Identifier: Apache-2.0
#include "helpers.h"
#include "samples.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/read_mesh.h"

namespace palpate::mesh::test {
namespace {

using Nodes = std::vector<std::int32_t>;

TetMesh readMedit(const std::string& text) {
  const TemporaryFolder folder;
  return readMesh(folder.write("a.mesh", text));
}

TEST(ReadMedit, TakesReferencesAsGroupsAndSkipsWhatItDoesNotNeed) {
  const TetMesh mesh = readMedit(kMedit);
  EXPECT_EQ(mesh.node_tags, (std::vector<std::int64_t>{1, 2, 4, 5, 6}));
  EXPECT_EQ(mesh.tetrahedron_tags, (std::vector<std::int64_t>{1, 2}));
  ASSERT_EQ(mesh.groups.size(), 3U);
  EXPECT_EQ(mesh.groups.at("6"), (Nodes{1, 2, 3}));
  EXPECT_EQ(mesh.groups.at("7"), (Nodes{1, 2, 3, 4}));
  EXPECT_EQ(mesh.groups.at("3"), (Nodes{4}));
  EXPECT_EQ(mesh.regions, (std::map<std::string, Nodes>{{"7", {1}}}));
  EXPECT_NO_THROW(checkMesh(mesh));
}

TEST(ReadMedit, RefusesOtherFiles) {
  EXPECT_REFUSED(readMedit("hello"), "no MeshVersionFormatted");
  EXPECT_REFUSED(readMedit(with(kMedit, "Dimension 3", "Dimension 2")), "line 3", "dimension is not 3");
  EXPECT_REFUSED(readMedit(with(kMedit, "Normals\n1", "?what 3")), "not a keyword");
}

TEST(ReadMedit, RefusesOtherVolumeElements) {
  EXPECT_REFUSED(readMedit(with(kMedit, "Tetrahedra", "Hexahedra")), "Hexahedra");
  EXPECT_REFUSED(readMedit(with(kMedit, "Tetrahedra", "TetrahedraP2")), "TetrahedraP2");
}

TEST(ReadMedit, RefusesANodeThatIsNotThere) {
  EXPECT_REFUSED(readMedit(with(kMedit, "2 4 5 6 7", "2 4 5 7 7")), "tetrahedron 2", "node 7");
  EXPECT_REFUSED(readMedit(with(kMedit, "2 4 5 6 7", "0 4 5 6 7")), "tetrahedron 2", "node 0");
}

TEST(ReadMedit, RefusesCountsThatDoNotFit) {
  EXPECT_REFUSED(readMedit(with(kMedit, "Vertices\n6", "Vertices\n6000000")),
                 "number of Vertices is 6000000");
  EXPECT_REFUSED(readMedit(with(kMedit, "Tetrahedra\n2", "Tetrahedra\n3")), "node or reference of Tetrahedra",
                 "'End'");
}

}  // namespace
}  // namespace palpate::mesh::test
