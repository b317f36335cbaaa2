// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/write_msh.h"

#include <iterator>
#include <set>

#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/quadratic.h"
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

// In the unit box: the half below x = 0.4, a group of nodes on the plane x = 0 and one with the region's name.
TetMesh boxOfTwoTissues() {
  TetMesh mesh = makeBox({1, 1, 1}, {4, 4, 4});
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    double x = 0;
    for (const auto node : mesh.tetrahedra[t]) x += mesh.nodes[static_cast<std::size_t>(node)].x() / 4;
    mesh.regions[x < 1.0 / 3 ? "soft" : "hard"].push_back(static_cast<std::int32_t>(t));
  }
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (mesh.nodes[i].x() == 0) mesh.groups["fixed"].push_back(static_cast<std::int32_t>(i));
    if (mesh.nodes[i].x() < 0.4 || i == 63) mesh.groups["soft"].push_back(static_cast<std::int32_t>(i));
  }
  return mesh;
}

// The numbers of a region's tetrahedra: the file lists regions one after the other.
std::set<std::int64_t> numbersIn(const TetMesh& mesh, const std::string& region) {
  std::set<std::int64_t> numbers;
  for (const auto t : mesh.regions.at(region))
    numbers.insert(mesh.tetrahedron_tags[static_cast<std::size_t>(t)]);
  return numbers;
}

TEST(WriteMsh, RegionsComeBackTheSame) {
  for (const bool is_quadratic : {false, true}) {
    const TetMesh mesh = is_quadratic ? quadraticOf(boxOfTwoTissues()) : boxOfTwoTissues();
    const TetMesh back = throughFile(mesh);
    EXPECT_NO_THROW(checkMesh(back));
    EXPECT_EQ(back.nodes, mesh.nodes);
    EXPECT_EQ(back.regions.size(), 3U);  // with that of the whole organ
    EXPECT_EQ(numbersIn(back, "organ").size(), mesh.tetrahedra.size());
    for (const char* region : {"soft", "hard"}) EXPECT_EQ(numbersIn(back, region), numbersIn(mesh, region));
    EXPECT_EQ(numbersIn(back, "soft").size(), 54U);
    for (const char* group : {"soft", "fixed"}) EXPECT_EQ(back.groups.at(group), mesh.groups.at(group));
    EXPECT_EQ(throughFile(back).regions, back.regions);
  }
}

TEST(WriteMsh, QuadraticTetrahedraComeBackTheSame) {
  const TetMesh mesh = quadraticOf(makeBeam());
  const TetMesh back = throughFile(mesh);
  EXPECT_EQ(back.nodes, mesh.nodes);
  EXPECT_EQ(back.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(back.midsides, mesh.midsides);
  for (const char* group : {"fixed", "accessible"}) EXPECT_EQ(back.groups.at(group), mesh.groups.at(group));
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
  mesh = boxOfTwoTissues();
  mesh.regions["organ"] = {0};
  EXPECT_REFUSED(writeMsh(folder / "a.msh", mesh, boundaryOf(mesh)), "'organ' is kept");
}

}  // namespace
}  // namespace palpate::mesh::test
