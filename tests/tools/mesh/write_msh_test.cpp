// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/write_msh.h"

#include <iterator>

#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/read_mesh.h"
#include "tools/mesh/topology.h"

namespace palpate::mesh::test {
namespace {

std::ptrdiff_t entriesOf(const TemporaryFolder& folder) {
  return std::distance(std::filesystem::directory_iterator(folder / "."), {});
}

TetMesh throughFile(const TetMesh& mesh) {
  const TemporaryFolder folder;
  writeMsh(folder / "a.msh", mesh, boundaryOf(mesh));
  EXPECT_EQ(entriesOf(folder), 1);  // nothing is left beside it
  return readMesh(folder / "a.msh");
}

TEST(WriteMsh, BeamComesBackTheSame) {
  const TetMesh beam = makeBeam();
  const TetMesh back = throughFile(beam);
  EXPECT_EQ(back.nodes, beam.nodes);
  EXPECT_EQ(back.node_tags, beam.node_tags);
  EXPECT_EQ(back.tetrahedra, beam.tetrahedra);
  EXPECT_EQ(back.tetrahedron_tags, beam.tetrahedron_tags);
  EXPECT_EQ(back.groups.at("fixed"), beam.groups.at("fixed"));
  EXPECT_EQ(back.groups.at("accessible"), beam.groups.at("accessible"));
  EXPECT_EQ(back.groups.at("organ").size(), beam.nodes.size());
  EXPECT_EQ(back.groups.size(), 3U);
}

TEST(WriteMsh, GroupsOfAnyNodesComeBackTheSame) {
  TetMesh mesh = makeBox({1, 1, 1}, {4, 4, 4});
  mesh.groups["inside"] = {21, 22};               // no boundary triangle has them
  mesh.groups["scattered"] = {0, 9, 21, 40, 63};  // here and there
  mesh.groups["corner and a bit"] = {0, 1,  2, 4,
                                     5, 16, 63};  // whole triangles and more, overlapping the others
  mesh.groups["all"].resize(mesh.nodes.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) mesh.groups["all"][i] = static_cast<std::int32_t>(i);
  const auto wanted = mesh.groups;
  TetMesh back = throughFile(mesh);
  back.groups.erase("organ");
  EXPECT_EQ(back.groups, wanted);
}

TEST(WriteMsh, CanBeRepeated) {
  const TetMesh once = throughFile(makeBeam());
  EXPECT_EQ(throughFile(once).groups, once.groups);
}

TEST(WriteMsh, NumbersFromOneInOrderWhateverTheNumbersWere) {
  const TetMesh back = throughFile(oneTetrahedron());
  EXPECT_EQ(back.node_tags, (std::vector<std::int64_t>{1, 2, 3, 4}));
  EXPECT_EQ(back.tetrahedron_tags, (std::vector<std::int64_t>{1}));
}

TEST(WriteMsh, KeepsCoordinatesToTheLastBit) {
  TetMesh mesh = oneTetrahedron();
  mesh.nodes[1].x() = 1.0 / 3;
  mesh.nodes[2].y() = 0.1 + 0.2;
  EXPECT_EQ(throughFile(mesh).nodes, mesh.nodes);
}

TEST(WriteMsh, RefusesAPlaceThatCannotBeWritten) {
  const TetMesh mesh = oneTetrahedron();
  const TemporaryFolder folder;
  EXPECT_REFUSED(writeMsh(folder / "none/a.msh", mesh, boundaryOf(mesh)), "none/a.msh",
                 "cannot be written: No such file or directory");
}

TEST(WriteMsh, AFolderOfThatNameStaysAndNothingIsLeftBesideIt) {
  const TetMesh mesh = oneTetrahedron();
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a.msh");
  EXPECT_REFUSED(writeMsh(folder / "a.msh", mesh, boundaryOf(mesh)),
                 "a.msh: cannot be written: Is a directory");
  EXPECT_EQ(entriesOf(folder), 1);
}

TEST(WriteMsh, TellsThatTheDiskIsFull) {
  const TetMesh mesh = makeBeam();
  const TemporaryFolder folder;
  const std::string beside = "a.msh.tmp-" + std::to_string(getpid());
  std::filesystem::create_symlink("/dev/full", folder / beside);
  EXPECT_REFUSED(writeMsh(folder / "a.msh", mesh, boundaryOf(mesh)),
                 "a.msh: cannot be written: No space left");
  EXPECT_EQ(entriesOf(folder), 0);
}

TEST(WriteMsh, RefusesGroupNamesThatTheFormatCannotHold) {
  TetMesh mesh = oneTetrahedron();
  const TemporaryFolder folder;
  mesh.groups["a \" quote"] = {0};
  EXPECT_REFUSED(writeMsh(folder / "a.msh", mesh, boundaryOf(mesh)), "a \" quote");
  mesh.groups = {{"organ", {0}}};
  EXPECT_REFUSED(writeMsh(folder / "a.msh", mesh, boundaryOf(mesh)), "'organ' is kept");
}

}  // namespace
}  // namespace palpate::mesh::test
