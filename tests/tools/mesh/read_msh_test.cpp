// SPDX-License-Identifier: Apache-2.0
#include "helpers.h"
#include "palpate/testing/paths.h"
#include "samples.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/read_mesh.h"

namespace palpate::mesh::test {
namespace {

using Nodes = std::vector<std::int32_t>;

TetMesh readMsh(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  return readMesh(folder.write(name, text));
}

void expectTwoTetrahedra(const TetMesh& mesh) {
  EXPECT_EQ(mesh.node_tags, (std::vector<std::int64_t>{10, 2, 30, 4, 50}));
  EXPECT_EQ(mesh.tetrahedron_tags, (std::vector<std::int64_t>{3, 8}));
  ASSERT_EQ(mesh.tetrahedra.size(), 2U);
  EXPECT_EQ(mesh.tetrahedra[0], (std::array<std::int32_t, 4>{0, 1, 2, 3}));
  EXPECT_EQ(mesh.tetrahedra[1], (std::array<std::int32_t, 4>{1, 2, 3, 4}));
  EXPECT_EQ(mesh.nodes[4], Eigen::Vector3d(1, 1, 1));
  EXPECT_NO_THROW(checkMesh(mesh));
}

TEST(ReadMsh, Version1KeepsNumbersAndDropsTheIdleNode) {
  const TetMesh mesh = readMsh("a.msh", kMsh1);
  expectTwoTetrahedra(mesh);
  ASSERT_EQ(mesh.groups.size(), 3U);
  EXPECT_EQ(mesh.groups.at("5"), (Nodes{0, 1}));
  EXPECT_EQ(mesh.groups.at("6"), (Nodes{1, 2, 3}));
  EXPECT_EQ(mesh.groups.at("7"), (Nodes{1, 2, 3, 4}));
}

TEST(ReadMsh, Version2NamesGroupsAndTellsDimensionsApart) {
  const TetMesh mesh = readMsh("a.msh", kMsh2);
  expectTwoTetrahedra(mesh);
  ASSERT_EQ(mesh.groups.size(), 4U);
  EXPECT_EQ(mesh.groups.at("lower face"), (Nodes{1, 2, 3}));
  EXPECT_EQ(mesh.groups.at("upper"), (Nodes{1, 2, 3, 4}));
  EXPECT_EQ(mesh.groups.at("curve:6"), (Nodes{0, 1}));
  EXPECT_EQ(mesh.groups.at("point:6"), (Nodes{4}));
}

TEST(ReadMsh, Version4TakesGroupsFromEntities) {
  const TetMesh mesh = readMsh("a.msh", kMsh4);
  expectTwoTetrahedra(mesh);
  ASSERT_EQ(mesh.groups.size(), 4U);
  EXPECT_EQ(mesh.groups.at("lower face"), (Nodes{1, 2, 3}));
  EXPECT_EQ(mesh.groups.at("11"), (Nodes{1, 2, 3}));
  EXPECT_EQ(mesh.groups.at("7"), (Nodes{1, 2, 3, 4}));
  EXPECT_EQ(mesh.groups.at("9"), (Nodes{4}));
}

TEST(ReadMsh, GroupsOfTheSameNameAreOne) {
  const TetMesh mesh = readMsh("a.msh", with(with(kMsh2, "\n2\n2 6", "\n3\n0 6 \"lower face\"\n2 6"),
                                             "9 15 2 6 1 50", "9 15 2 6 1 10"));
  EXPECT_EQ(mesh.groups.at("lower face"), (Nodes{0, 1, 2, 3}));
}

TEST(ReadMsh, TetrahedronListedOncePerGroupIsOne) {
  const TetMesh two = readMsh("a.msh", with(with(kMsh2, "$Elements\n5", "$Elements\n6"), "9 15 2 6",
                                            "11 4 2 9 1 2 30 4 50\n9 15 2 6"));
  expectTwoTetrahedra(two);
  EXPECT_EQ(two.groups.at("upper"), two.groups.at("9"));
  const TetMesh one =
      readMsh("a.msh", with(with(kMsh1, "$ELM\n4", "$ELM\n5"), "$ENDELM", "11 4 9 1 4 2 30 4 50\n$ENDELM"));
  expectTwoTetrahedra(one);
  EXPECT_EQ(one.groups.at("7"), one.groups.at("9"));
}

TEST(ReadMsh, TetrahedronListedTwiceInOneGroupIsRefusedByTheCheck) {
  const auto refused = [](const std::string& group) {
    return checkMesh(
        readMsh("a.msh", with(with(kMsh2, "$Elements\n5", "$Elements\n7"), "9 15 2 6",
                              "11 4 2 9 1 2 30 4 50\n12 4 2 " + group + " 1 2 30 4 50\n9 15 2 6")));
  };
  EXPECT_REFUSED(refused("7"), "tetrahedron 12", "same nodes as tetrahedron 8");
  EXPECT_REFUSED(refused("9"), "tetrahedron 12", "same nodes as tetrahedron 8");
  EXPECT_REFUSED(refused("0"), "tetrahedron 12", "same nodes as tetrahedron 8");
}

TEST(ReadMsh, TakesCarriageReturns) {
  std::string text = kMsh2;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, 1, '\r');
  expectTwoTetrahedra(readMsh("a.msh", text));
}

TEST(ReadMsh, RefusesMissingFileFolderAndEmptyFile) {
  const TemporaryFolder folder;
  EXPECT_REFUSED(readMesh(folder / "none.msh"), "none.msh", "no such file");
  std::filesystem::create_directory(folder / "folder.msh");
  EXPECT_REFUSED(readMesh(folder / "folder.msh"), "folder.msh", "not a regular file");
  EXPECT_REFUSED(readMesh(folder.write("empty.msh", "")), "empty.msh", "is empty");
}

TEST(ReadMsh, RefusesAnUnknownExtension) {
  EXPECT_REFUSED(readMsh("a.stp", kMsh2), "'.stp'", ".msh, .vtk, .mesh");
}

TEST(ReadMsh, RefusesWhatIsNotAMesh) {
  EXPECT_REFUSED(readMsh("a.msh", "hello world"), "line 1", "not a Gmsh mesh");
  EXPECT_REFUSED(readMsh("a.msh", std::string("\x7f"
                                              "ELF\0\1\2\3",
                                              8)),
                 "not a Gmsh mesh");
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh2, "2.2 0 8", "3.0 0 8")), "line 2", "version is '3.0'");
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh2, "2.2 0 8", "2.2 0 4")), "data size is 4");
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh4, "4.1 0 8", "4 1 8")), "binary files of version 4.0");
  EXPECT_REFUSED(readMsh("a.msh", kMsh2.substr(kMsh2.find("$Nodes"))), "before $MeshFormat");
}

TEST(ReadMsh, RefusesANodeThatIsNotThere) {
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh1, "4 2 30 4 50", "4 2 30 4 51")), "tetrahedron 8", "node 51");
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh2, "6 6 2 30 4", "6 6 2 31 4")), "group 'lower face'", "node 31");
}

TEST(ReadMsh, RefusesANodeThatIsThereTwice) {
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh1, "30 0 1 0", "10 0 1 0")), "node 10 is there twice");
}

TEST(ReadMsh, RefusesVolumeElementsThatAreNotTetrahedra) {
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh2, "8 4 4 7", "8 29 4 7")), "element 8", "type 29");
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh2, "8 4 4 7", "8 5 4 7")), "element 8", "type 5");
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh2, "8 4 4 7", "8 77 4 7")), "element 8", "type 77");
}

TEST(ReadMsh, RefusesAMeshWithoutTetrahedra) {
  EXPECT_REFUSED(readMsh("a.msh", with(with(kMsh1, "3 4 0 1 4 10 2 30 4\n8 4 7 1 4 2 30 4 50\n", ""),
                                       "$ELM\n4", "$ELM\n2")),
                 "holds no tetrahedra");
}

TEST(ReadMsh, RefusesCountsThatTheFileCannotHold) {
  for (const char* count : {"999999999999", "9223372036854775807", "-3", "many", "6.5"}) {
    EXPECT_REFUSED(readMsh("a.msh", with(kMsh2, "$Nodes\n6", std::string("$Nodes\n") + count)),
                   "number of nodes", count);
    EXPECT_REFUSED(readMsh("a.msh", with(kMsh2, "$Elements\n5", std::string("$Elements\n") + count)),
                   "number of elements", count);
    EXPECT_REFUSED(readMsh("a.msh", with(kMsh4, "2 1 2 1\n", std::string("2 1 2 ") + count + "\n")),
                   "size of a block", count);
  }
  EXPECT_REFUSED(readMsh("a.msh", "$NOD\n3\n1 0 0 0\n2 0 0 0"), "number of nodes is 3, but only 16 bytes");
  EXPECT_REFUSED(readMsh("a.msh", "$NOD\n2\n1 0 0 0\n2 0 0 0"), "the file ends where $ENDNOD is expected");
}

// All elements of an entity would be listed in each of its groups.
TEST(ReadMsh, RefusesAnEntityInMoreGroupsThanAnyHas) {
  const std::string entity = "1 0 0 0 1 1 1 ";  // its tag and its bounding box
  const auto file = [&](const std::string& entities) {
    return "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 " + entities + "$EndEntities\n";
  };
  EXPECT_REFUSED(readMsh("a.msh", file("1\n" + entity + "17 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 0\n")),
                 "line 6", "an entity is in 17 physical groups, expected at most 16");
  EXPECT_REFUSED(
      readMsh("a.msh", file("2\n" + entity + "9 1 2 3 4 5 6 7 8 9 0\n" + entity + "8 1 2 3 4 5 6 7 8 0\n")),
      "an entity is in 17 physical groups");
  EXPECT_REFUSED(readMsh("a.msh", file("1\n" + entity + "1 -9223372036854775808 0\n")),
                 "an entity's physical group is -9223372036854775808");
}

TEST(ReadMsh, RefusesCountsThatDoNotMatch) {
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh1, "$NOD\n6", "$NOD\n5")), "does not end with $ENDNOD");
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh1, "8 4 7 1 4", "8 4 7 1 5")), "element 8 has 5 nodes");
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh4, "2 6 2 99", "2 7 2 99")), "6 nodes, the section announces 7");
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh4, "4 4 1 8", "4 5 1 8")), "4 elements, the section announces 5");
}

TEST(ReadMsh, RefusesACoordinateThatIsNoNumber) {
  EXPECT_REFUSED(readMsh("a.msh", with(kMsh1, "30 0 1 0", "30 0 x1 0")), "line 6", "'x1'");
}

TEST(ReadMsh, NonFiniteCoordinateIsFoundByTheCheck) {
  EXPECT_REFUSED(checkMesh(readMsh("a.msh", with(kMsh1, "30 0 1 0", "30 0 nan 0"))), "node 30", "not finite");
}

TEST(ReadMsh, ReadsTheLiverOfTheSofaFramework) {
  const std::filesystem::path file = palpate::testing::dataDir() + "/sofa-liver/liver2.msh";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const TetMesh mesh = readMesh(file);
  EXPECT_EQ(mesh.nodes.size(), 507U);
  EXPECT_EQ(mesh.tetrahedra.size(), 1493U);
  EXPECT_EQ(mesh.node_tags[1], 9);
  EXPECT_NO_THROW(checkMesh(mesh));
}

}  // namespace
}  // namespace palpate::mesh::test
