// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/import_organ.h"

#include "helpers.h"
#include "samples.h"
#include "spoiled_sphere.h"
#include "tools/make/organ/paper_liver.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/topology.h"
#include "tools/mesh/write_msh.h"

namespace palpate::organ::test {
namespace {

using mesh::test::TemporaryFolder;

TEST(ImportOrgan, ScalesAndKeepsTheOrderOfTheNodes) {
  const TemporaryFolder folder;
  ImportOptions options;
  options.scale = 0.1;
  ImportedOrgan organ = importOrgan(folder.write("a.msh", mesh::test::kMsh1), options);
  EXPECT_EQ(organ.mesh.nodes[4], Eigen::Vector3d(0.1, 0.1, 0.1));
  EXPECT_EQ(organ.mesh.node_tags.front(), 10);
  renumber(organ.mesh);
  EXPECT_EQ(organ.mesh.node_tags, (std::vector<std::int64_t>{1, 2, 3, 4, 5}));
  EXPECT_EQ(organ.mesh.tetrahedron_tags, (std::vector<std::int64_t>{1, 2}));
}

TEST(ImportOrgan, TellsThatNothingIsFixed) {
  const TemporaryFolder folder;
  const ImportedOrgan organ = importOrgan(folder.write("a.msh", mesh::test::kMsh1), {});
  ASSERT_EQ(organ.notes.size(), 2U);
  EXPECT_NE(organ.notes[1].find("nothing is fixed"), std::string::npos);
}

TEST(ImportOrgan, NamesTheGroupsThatAreNotKept) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.msh", mesh::test::kMsh1);
  EXPECT_EQ(importOrgan(file, {}).notes.front(), "groups of the file that are not kept: 5, 6");
  ImportOptions options;
  options.fixed = {parseFixedRule("group:6")};
  EXPECT_EQ(importOrgan(file, options).notes,
            std::vector<std::string>{"groups of the file that are not kept: 5"});
}

TEST(ImportOrgan, LiverComesBackWithItsGroups) {
  const TemporaryFolder folder;
  const mesh::TetMesh liver = makePaperLiver();
  const auto boundary = mesh::boundaryOf(liver);
  mesh::writeMsh(folder / "liver.msh", liver, boundary);
  const ImportedOrgan back = importOrgan(folder / "liver.msh", {});
  EXPECT_EQ(back.mesh.groups, liver.groups);
  EXPECT_LT(back.mesh.groups.at("accessible").size() + back.mesh.groups.at("fixed").size(),
            boundary.nodes.size());  // the rim is in neither
  EXPECT_TRUE(back.notes.empty());
}

TEST(ImportOrgan, KeepsRegions) {
  const TemporaryFolder folder;
  const ImportedOrgan organ = importOrgan(folder.write("a.msh", mesh::test::kMsh2), {});
  EXPECT_EQ(organ.mesh.regions, (std::map<std::string, std::vector<std::int32_t>>{{"upper", {1}}}));
  EXPECT_EQ(organ.mesh.groups.size(), 1U);  // accessible
}

TEST(ImportOrgan, StraightensCurvedEdgesAndSaysSo) {
  const TemporaryFolder folder;
  mesh::TetMesh box = mesh::quadraticOf(mesh::makeBox({0.1, 0.1, 0.1}, {3, 3, 3}));
  const auto node = static_cast<std::size_t>(box.midsides[5][2]);
  const Eigen::Vector3d middle = box.nodes[node];
  box.nodes[node].y() += 0.0015;
  mesh::writeMsh(folder / "a.msh", box, mesh::boundaryOf(box));
  ImportOptions options;
  options.fixed = {parseFixedRule("lowest-z:0.3")};
  const ImportedOrgan organ = importOrgan(folder / "a.msh", options);
  ASSERT_EQ(organ.notes.size(), 1U);
  EXPECT_NE(organ.notes[0].find("1 edges were curved"), std::string::npos) << organ.notes[0];
  EXPECT_NE(organ.notes[0].find("1.5 mm"), std::string::npos) << organ.notes[0];
  EXPECT_EQ(organ.mesh.nodes[node], middle);
}

TEST(ImportOrgan, TurnsAnInvertedMeshOverAndSaysSo) {
  const TemporaryFolder folder;
  mesh::TetMesh box = mesh::makeBox({1, 1, 1}, {3, 3, 3});
  const auto boundary = mesh::boundaryOf(box);
  for (auto& t : box.tetrahedra) std::swap(t[0], t[1]);
  mesh::writeMsh(folder / "a.msh", box, boundary);
  ImportOptions options;
  options.fixed = {parseFixedRule("lowest-z:0.3")};
  const ImportedOrgan organ = importOrgan(folder / "a.msh", options);
  ASSERT_EQ(organ.notes.size(), 1U);
  EXPECT_NE(organ.notes[0].find("turned over"), std::string::npos);
}

TEST(ImportOrgan, RefusesOneInvertedTetrahedronByFileAndNumber) {
  const TemporaryFolder folder;
  std::string text = mesh::test::kMsh1;
  text.replace(text.find("2 30 4 50"), 9, "30 2 4 50");
  EXPECT_REFUSED(importOrgan(folder.write("a.msh", text), {}), "a.msh: tetrahedron 8 is inverted");
}

TEST(ImportOrgan, RaisesALinearMeshAndItsGroups) {
  const TemporaryFolder folder;
  mesh::TetMesh box = mesh::makeBox({0.1, 0.1, 0.1}, {3, 3, 3});
  const auto file = folder / "a.msh";
  mesh::writeMsh(file, box, mesh::boundaryOf(box));
  ImportOptions options;
  options.fixed = {parseFixedRule("box:0,0,0,0.1,0.1,0")};
  options.order = 2;
  const ImportedOrgan organ = importOrgan(file, options);
  EXPECT_EQ(organ.mesh.nodes.size(), 125U);
  EXPECT_EQ(organ.mesh.groups.at("fixed").size(), 25U);
  EXPECT_EQ(organ.boundary.nodes.size(), 98U);
  EXPECT_EQ(organ.mesh.groups.at("accessible").size(), 98U - 25U - 16U);  // edges with one end held
  mesh::writeMsh(file, organ.mesh, organ.boundary);
  options.fixed = {};
  EXPECT_EQ(importOrgan(file, options).mesh.midsides, organ.mesh.midsides);  // as it is
  options.order = 1;
  EXPECT_REFUSED(importOrgan(file, options), "--element-order 1: the elements of the file are quadratic");
}

TEST(ImportOrgan, RefusesWhatIsForTheOtherKindOfFile) {
  const TemporaryFolder folder;
  const auto tetrahedra = folder.write("a.msh", mesh::test::kMsh1);
  writeStl((folder / "ball.stl").string(), sphere(0.05, 3));
  ImportOptions options;
  options.repair = true;
  EXPECT_REFUSED(importOrgan(tetrahedra, options), "--repair is for surfaces");
  options.repair = false;
  options.part = "1";
  EXPECT_REFUSED(importOrgan(tetrahedra, options), "--part is for surfaces");
  options.part.reset();
  options.fixed = {parseFixedRule("group:vessel")};
  EXPECT_REFUSED(importOrgan(folder / "ball.stl", options), "--fixed group:vessel: there is no such group",
                 "the file has none");
}

TEST(ImportOrgan, RefusesOptionsOutOfRange) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.msh", mesh::test::kMsh1);
  for (const double wrong : {0.0, -1.0, 1.0 / 0.0}) {
    ImportOptions options;
    options.scale = wrong;
    EXPECT_REFUSED(importOrgan(file, options), "--scale");
  }
  ImportOptions options;
  options.sizes.surface = 0.01;
  EXPECT_REFUSED(importOrgan(file, options), "--element-size and --inner-size are for surfaces");
  options.sizes.surface = -1;
  EXPECT_REFUSED(importOrgan(file, options), "--element-size must be");
  options.sizes = {0.01, 0.02, 0};
  EXPECT_REFUSED(importOrgan(file, options), "--growth must be above 0");
  options.sizes = {};
  options.order = 3;
  EXPECT_REFUSED(importOrgan(file, options), "--element-order must be 1 or 2, not 3");
}

}  // namespace
}  // namespace palpate::organ::test
