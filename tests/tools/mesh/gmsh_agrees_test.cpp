// SPDX-License-Identifier: Apache-2.0
// Gmsh itself reads what we write and writes what we read.
#include <gmsh.h>

#include <csignal>
#include <set>

#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/gmsh_session.h"
#include "tools/mesh/midsides.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/read_mesh.h"
#include "tools/mesh/statistics.h"
#include "tools/mesh/topology.h"
#include "tools/mesh/write_msh.h"

namespace palpate::mesh::test {
namespace {

struct Format {
  const char* name;
  double version;
  bool binary;
  int order = 1;
};

class GmshFormat : public ::testing::TestWithParam<Format> {};

// A ball with its surface and one point as named groups.
TetMesh saveBall(const GmshSession& session, const std::filesystem::path& file, const Format& format) {
  TetMesh expected;
  session.run("ball", [&] {
    gmsh::model::add("ball");
    const int ball = gmsh::model::occ::addSphere(0, 0, 0, 1);
    gmsh::model::occ::synchronize();
    gmsh::option::setNumber("Mesh.MeshSizeMin", 0.5);
    gmsh::option::setNumber("Mesh.MeshSizeMax", 0.5);
    gmsh::model::mesh::generate(3);
    expected = session.tetrahedra();
    gmsh::model::mesh::setOrder(format.order);
    gmsh::vectorpair surfaces;
    gmsh::model::getEntities(surfaces, 2);
    const int skin = gmsh::model::addPhysicalGroup(2, {surfaces.at(0).second});
    gmsh::model::setPhysicalName(2, skin, "skin");
    gmsh::model::addPhysicalGroup(3, {ball}, 42);
    gmsh::option::setNumber("Mesh.SaveElementTagType", 2);  // Medit's references: the physical groups
    gmsh::option::setNumber("Mesh.MshFileVersion", format.version);
    gmsh::option::setNumber("Mesh.Binary", format.binary ? 1 : 0);
    gmsh::write(file.string());
  });
  return expected;
}

// Edges of the ball's surface, chords of 0.5 of the unit circle, bulge by h^2/8; edges inside are straight.
void straightenBall(TetMesh& mesh, std::size_t surface_edges) {
  const CurvedEdges curved = straighten(mesh);
  EXPECT_LE(curved.count, surface_edges);
  EXPECT_GE(curved.count, surface_edges / 2);
  EXPECT_GT(curved.farthest, 0.02);
  EXPECT_LT(curved.farthest, 0.06);
}

TEST_P(GmshFormat, IsRead) {
  const TemporaryFolder folder;
  const GmshSession session;
  const auto file = folder / GetParam().name;
  const TetMesh expected = saveBall(session, file, GetParam());
  TetMesh mesh = readMesh(file);
  ASSERT_EQ(mesh.isQuadratic(), GetParam().order == 2);
  if (mesh.isQuadratic()) straightenBall(mesh, 3 * boundaryOf(expected).faces.size() / 2);
  EXPECT_NO_THROW(checkMesh(mesh));
  EXPECT_EQ(statisticsOf(mesh, boundaryOf(mesh)).corners, expected.nodes.size());
  EXPECT_EQ(mesh.tetrahedra.size(), expected.tetrahedra.size());
  double volume = 0;
  double wanted = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    volume += signedVolume(mesh, t);
    wanted += signedVolume(expected, t);
  }
  EXPECT_NEAR(volume, wanted, 1e-6);
  if (!mesh.groups.empty()) {  // VTK has none
    const std::string skin = mesh.groups.contains("skin") ? "skin"
                             : mesh.groups.contains("1")  ? "1"
                                                          : "surface:1";
    EXPECT_EQ(mesh.groups.at(skin), boundaryOf(mesh).nodes);
    EXPECT_EQ(mesh.groups.at("42").size(), mesh.nodes.size());
    EXPECT_EQ(mesh.regions.at("42").size(), mesh.tetrahedra.size());
  }
  EXPECT_EQ(mesh.groups.empty(), std::string(GetParam().name).ends_with(".vtk"));
}

INSTANTIATE_TEST_SUITE_P(All, GmshFormat,
                         ::testing::Values(Format{"1.msh", 1, false}, Format{"2.msh", 2.2, false},
                                           Format{"2b.msh", 2.2, true}, Format{"40.msh", 4.0, false},
                                           Format{"41.msh", 4.1, false}, Format{"41b.msh", 4.1, true},
                                           Format{"a.vtk", 4.1, false}, Format{"b.vtk", 4.1, true},
                                           Format{"a.mesh", 4.1, false}, Format{"1q.msh", 1, false, 2},
                                           Format{"2q.msh", 2.2, false, 2}, Format{"2bq.msh", 2.2, true, 2},
                                           Format{"40q.msh", 4.0, false, 2}, Format{"41q.msh", 4.1, false, 2},
                                           Format{"41bq.msh", 4.1, true, 2}, Format{"aq.vtk", 4.1, false, 2},
                                           Format{"bq.vtk", 4.1, true, 2}),
                         [](const auto& format) {
                           std::string name = format.param.name;
                           name[name.find('.')] = '_';
                           return name;
                         });

TEST(GmshAgrees, ReadsWhatWeWrite) {
  const TemporaryFolder folder;
  TetMesh box = makeBox({1, 1, 1}, {4, 4, 4});
  box.groups["mixed"] = {0, 1, 4, 5, 16, 42, 63};  // whole triangles, one inner and one single node
  writeMsh(folder / "a.msh", box, boundaryOf(box));
  const GmshSession session;
  std::set<std::size_t> nodes;
  session.run("open", [&] {
    gmsh::open((folder / "a.msh").string());
    gmsh::vectorpair groups;
    gmsh::model::getPhysicalGroups(groups);
    for (const auto& [dimension, number] : groups) {
      std::string name;
      gmsh::model::getPhysicalName(dimension, number, name);
      if (name != "mixed") continue;
      std::vector<int> entities;
      gmsh::model::getEntitiesForPhysicalGroup(dimension, number, entities);
      for (const int entity : entities) {
        std::vector<int> types;
        std::vector<std::vector<std::size_t>> tags, corners;
        gmsh::model::mesh::getElements(types, tags, corners, dimension, entity);
        for (const auto& list : corners) nodes.insert(list.begin(), list.end());
      }
    }
  });
  EXPECT_EQ(nodes, (std::set<std::size_t>{1, 2, 5, 6, 17, 43, 64}));
  const TetMesh back = session.tetrahedra();
  EXPECT_EQ(back.nodes, box.nodes);
  EXPECT_EQ(back.tetrahedra, box.tetrahedra);
}

// One cube on another, with a conforming face: volumes 1 and 0.5.
TEST(GmshAgrees, VolumeGroupsAreRegions) {
  for (const double version : {2.2, 4.1}) {
    const TemporaryFolder folder;
    const GmshSession session;
    session.run("cubes", [&] {
      namespace occ = gmsh::model::occ;
      gmsh::vectorpair parts;
      std::vector<gmsh::vectorpair> origins;
      occ::fragment({{3, occ::addBox(0, 0, 0, 1, 1, 1)}}, {{3, occ::addBox(0, 0, 1, 1, 1, 0.5)}}, parts,
                    origins);
      occ::synchronize();
      gmsh::model::setPhysicalName(3, gmsh::model::addPhysicalGroup(3, {parts.at(0).second}), "lower");
      gmsh::model::setPhysicalName(3, gmsh::model::addPhysicalGroup(3, {parts.at(1).second}), "upper");
      gmsh::model::setPhysicalName(3, gmsh::model::addPhysicalGroup(3, {1, 2}), "both");
      gmsh::option::setNumber("Mesh.MeshSizeMax", 0.4);
      gmsh::model::mesh::generate(3);
      gmsh::option::setNumber("Mesh.MshFileVersion", version);
      gmsh::write((folder / "a.msh").string());
    });
    const TetMesh mesh = readMesh(folder / "a.msh");
    EXPECT_NO_THROW(checkMesh(mesh));
    const auto volumeOf = [&](const std::string& region) {
      double volume = 0;
      for (const auto t : mesh.regions.at(region)) volume += signedVolume(mesh, static_cast<std::size_t>(t));
      return volume;
    };
    EXPECT_NEAR(volumeOf("lower"), 1, 1e-12);
    EXPECT_NEAR(volumeOf("upper"), 0.5, 1e-12);
    EXPECT_NEAR(volumeOf("both"), 1.5, 1e-12);
    EXPECT_EQ(mesh.groups.at("both").size(), mesh.nodes.size());
  }
}

// With its last two nodes exchanged, an element's Jacobian varies within it.
TEST(GmshAgrees, ReadsQuadraticTetrahedraInOurOrder) {
  const TemporaryFolder folder;
  const TetMesh box = quadraticOf(makeBox({1, 2, 3}, {3, 3, 3}));
  writeMsh(folder / "a.msh", box, boundaryOf(box));
  const GmshSession session;
  std::vector<double> determinants;
  session.run("open", [&] {
    gmsh::open((folder / "a.msh").string());
    std::vector<double> points, weights, jacobians, coordinates;
    gmsh::model::mesh::getIntegrationPoints(11, "Gauss4", points, weights);
    gmsh::model::mesh::getJacobians(11, points, jacobians, determinants, coordinates);
    ASSERT_EQ(determinants.size(), weights.size() * box.tetrahedra.size());
  });
  for (const double determinant : determinants) EXPECT_NEAR(determinant, 6 * 6.0 / 48, 1e-12);
}

TEST(GmshSession, LeavesSignalHandlersAlone) {
  struct sigaction before {};
  struct sigaction during {};
  struct sigaction after {};
  sigaction(SIGINT, nullptr, &before);
  {
    const GmshSession session;
    sigaction(SIGINT, nullptr, &during);
  }
  sigaction(SIGINT, nullptr, &after);
  EXPECT_EQ(before.sa_handler, during.sa_handler);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
}

TEST(GmshSession, TurnsWhatGmshThrowsIntoOneLine) {
  const GmshSession session;
  gmsh::vectorpair rounded;
  EXPECT_REFUSED(session.run("boom", [&] { gmsh::model::occ::fillet({99}, {1}, {0.1}, rounded); }),
                 "boom: ", "curve with tag 1");
}

}  // namespace
}  // namespace palpate::mesh::test
