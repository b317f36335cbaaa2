// SPDX-License-Identifier: Apache-2.0
// Surfaces (.stl, .obj) that importOrgan() fills.
#include "helpers.h"
#include "spoiled_sphere.h"
#include "tools/make/organ/import_organ.h"
#include "tools/mesh/topology.h"

namespace palpate::organ::test {
namespace {

using mesh::test::TemporaryFolder;

std::string cubeAsObj() {
  std::string text;
  const mesh::TriangleSurface cube = mesh::test::cube();
  for (const auto& x : cube.vertices) {
    for (const double c : x) text += (text.empty() || text.back() == '\n' ? "v " : " ") + std::to_string(c);
    text += '\n';
  }
  for (const auto& t : cube.triangles) {
    text += "f " + std::to_string(t[0] + 1) + ' ' + std::to_string(t[1] + 1) + ' ' +
            std::to_string(t[2] + 1) + '\n';
  }
  return text;
}

TEST(ImportOrgan, FillsASurface) {
  const TemporaryFolder folder;
  ImportOptions options;
  options.scale = 0.1;
  options.sizes.surface = 0.03;
  options.fixed = {parseFixedRule("box:-1,-1,-1,1,1,1e-9")};
  const ImportedOrgan organ = importOrgan(folder.write("a.obj", cubeAsObj()), options);
  EXPECT_GT(organ.mesh.groups.at("fixed").size(), 16U);
  EXPECT_TRUE(organ.notes.empty());
  for (const auto& x : organ.mesh.nodes) EXPECT_LE(x.maxCoeff(), 0.1 + 1e-12);
}

TEST(ImportOrgan, FillsASurfaceWithFewerElementsInside) {
  const TemporaryFolder folder;
  ImportOptions options;
  options.scale = 0.1;
  options.sizes.surface = 0.007;
  options.fixed = {parseFixedRule("box:-1,-1,-1,1,1,1e-9")};
  const auto file = folder.write("a.obj", cubeAsObj());
  const ImportedOrgan even = importOrgan(file, options);
  options.sizes.inner = 0.04;
  options.order = 2;
  const ImportedOrgan graded = importOrgan(file, options);
  EXPECT_TRUE(graded.mesh.isQuadratic());
  EXPECT_GT(graded.boundary.faces.size(), even.boundary.faces.size() * 8 / 10);
  EXPECT_LT(graded.mesh.tetrahedra.size(), even.mesh.tetrahedra.size() * 3 / 4);
}

TEST(ImportOrgan, ListsAllDefectsOfASurfaceAndOffersTheRepair) {
  const TemporaryFolder folder;
  writeStl((folder / "scan.stl").string(), spoiledSphere(0.05, 4));
  EXPECT_REFUSED(importOrgan(folder / "scan.stl", {}), "scan.stl: the surface bounds no solid",
                 "--repair repairs it", "1 triangle has no area", "3 triangles are there twice",
                 "holes: the surface is not closed", "parts are turned over", "pairs of triangles intersect",
                 ") m (triangles ");
}

TEST(ImportOrgan, ARepairedScanIsAnOrganOfTheSoundVolume) {
  const TemporaryFolder folder;
  writeStl((folder / "scan.stl").string(), spoiledSphere(0.05, 4), 0.001);
  std::string said;
  ImportOptions options;
  options.scale = 0.001;
  options.repair = true;
  options.fixed = {parseFixedRule("-z")};
  options.say = [&](const std::string& line) { said += line + '\n'; };
  const ImportedOrgan organ = importOrgan(folder / "scan.stl", options);
  double volume = 0;
  for (std::size_t t = 0; t < organ.mesh.tetrahedra.size(); ++t) volume += mesh::signedVolume(organ.mesh, t);
  EXPECT_NEAR(volume / mesh::enclosedVolume(sphere(0.05, 4)), 1, 0.01);
  EXPECT_NE(said.find("repair           2 holes filled\n"), std::string::npos) << said;
  EXPECT_NE(said.find("estimate         about "), std::string::npos) << said;
}

void addSphere(mesh::TriangleSurface& surface, const mesh::TriangleSurface& other) {
  const auto offset = static_cast<std::int32_t>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles)
    surface.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

TEST(ImportOrgan, OneOfSeveralPartsIsChosen) {
  const TemporaryFolder folder;
  mesh::TriangleSurface two = sphere(0.02, 3);
  addSphere(two, sphere(0.05, 3, {0.1, 0, 0}));
  writeStl((folder / "two.stl").string(), two);
  ImportOptions options;
  options.fixed = {parseFixedRule("-z")};
  EXPECT_REFUSED(importOrgan(folder / "two.stl", options), "2 parts that are not joined", "--part largest",
                 " m^3 at (0.1 0 0) m; 2: ", " m^3 at (0 0 0) m");
  const auto leftmost = [&](const char* part) {
    options.part = part;
    const ImportedOrgan organ = importOrgan(folder / "two.stl", options);
    double x = 1;
    for (const auto& node : organ.mesh.nodes) x = std::min(x, node.x());
    EXPECT_NE(organ.notes.front().find(" of 2 is taken: 1: "), std::string::npos) << organ.notes.front();
    return x;
  };
  EXPECT_NEAR(leftmost("largest"), 0.05, 1e-6);
  EXPECT_NEAR(leftmost("2"), -0.02, 1e-6);
  options.part = "3";
  EXPECT_REFUSED(importOrgan(folder / "two.stl", options),
                 "--part 3: expected largest or a number from 1 to 2");
}

TEST(ImportOrgan, ASurfaceInsideIsACavity) {
  const TemporaryFolder folder;
  mesh::TriangleSurface hollow = sphere(0.05, 3);
  addSphere(hollow, sphere(0.02, 2));
  writeStl((folder / "hollow.stl").string(), hollow);
  ImportOptions options;
  options.fixed = {parseFixedRule("-z")};
  const ImportedOrgan organ = importOrgan(folder / "hollow.stl", options);
  EXPECT_NE(organ.notes.front().find("the organ has a cavity: 3.0"), std::string::npos)
      << organ.notes.front();
  double volume = 0;
  for (std::size_t t = 0; t < organ.mesh.tetrahedra.size(); ++t) volume += mesh::signedVolume(organ.mesh, t);
  EXPECT_NEAR(volume, mesh::enclosedVolume(sphere(0.05, 3)) - mesh::enclosedVolume(sphere(0.02, 2)), 1e-9);
  for (const auto node : organ.mesh.groups.at("accessible"))
    EXPECT_GT(organ.mesh.nodes[static_cast<std::size_t>(node)].norm(), 0.03);
}

TEST(ImportOrgan, RefusesSizesThatDoNotSuitTheBodyBeforeItIsFilled) {
  const TemporaryFolder folder;
  writeStl((folder / "ball.stl").string(), sphere(0.05, 3));
  ImportOptions options;
  options.sizes.surface = 0.0002;
  EXPECT_REFUSED(importOrgan(folder / "ball.stl", options), "--max-nodes: with --element-size 0.0002",
                 "more than the 100000 nodes allowed; --element-size 0.00");
  options.sizes.surface = 8;
  EXPECT_REFUSED(importOrgan(folder / "ball.stl", options), "--element-size: elements of 8 m are longer than",
                 "shortest side, 0.1 m", "meant in mm? --element-size 0.008");
  options.scale = 1e-3;  // of a file in metres: the size is right, the unit is not
  options.sizes.surface = 0.01;
  const std::string words = mesh::test::errorOf([&] { (void)importOrgan(folder / "ball.stl", options); });
  EXPECT_NE(words.find("shortest side, 0.0001 m; the body is 0.0001 m long, implausible for an organ: is the "
                       "file in m? --unit m makes it 0.1 m long"),
            std::string::npos)
      << words;
  EXPECT_EQ(words.find("resolves it"), std::string::npos) << words;
  options.scale = 1;
  options.sizes.surface = 0.008;
  options.scale = 1000;
  EXPECT_REFUSED(importOrgan(folder / "ball.stl", options), "the body is 100 m long",
                 "--unit m makes it 0.1 m");
  options.scale = 1;
  options.max_nodes = 200;
  EXPECT_REFUSED(importOrgan(folder / "ball.stl", options), "more than the 200 nodes allowed");
}

TEST(ImportOrgan, TellsOfVolumeThatCoarseElementsLose) {
  const TemporaryFolder folder;
  writeStl((folder / "ball.stl").string(), sphere(0.05, 4));
  ImportOptions options;
  options.sizes.surface = 0.045;
  options.fixed = {parseFixedRule("-z")};
  const ImportedOrgan organ = importOrgan(folder / "ball.stl", options);
  std::string notes;
  for (const auto& note : organ.notes) notes += note + '\n';
  EXPECT_NE(notes.find("2.2 elements of 0.045 m long; at most 0.0333 m resolves it"), std::string::npos)
      << notes;
  EXPECT_NE(notes.find("% less than the surface's"), std::string::npos) << notes;
}

}  // namespace
}  // namespace palpate::organ::test
