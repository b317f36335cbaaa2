// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/painted_groups.h"

#include <fstream>

#include "helpers.h"
#include "spoiled_sphere.h"
#include "tools/make/organ/import_organ.h"
#include "tools/make/organ/preview.h"
#include "tools/make/organ/repair/nearest_triangle.h"

namespace palpate::organ::test {
namespace {

using mesh::test::TemporaryFolder;

constexpr double kRadius = 0.05;  // m

/// Text OBJ, in `unit` metres: the triangles above z = 0.4 of the radius have the material `cap`, the others `skin`; all are in the group `body`.
void writePainted(const std::string& path, const mesh::TriangleSurface& s, double unit = 1) {
  std::ofstream out(path);
  out.precision(9);
  for (const auto& x : s.vertices) out << "v " << x.transpose() / unit << '\n';
  out << "g body\n";
  for (const bool cap : {true, false}) {
    out << (cap ? "usemtl cap\n" : "usemtl skin\n");
    for (const auto& t : s.triangles)
      if ((centreOf(s, t).z() > 0.4 * kRadius) == cap)
        out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
}

/// The held nodes lie where the cap is, and all of the cap is held. @param blur  at the border, m
void expectCapHeld(const mesh::TetMesh& mesh, double blur) {
  const auto& fixed = mesh.groups.at("fixed");
  for (const auto node : fixed)
    EXPECT_GT(mesh.nodes[static_cast<std::size_t>(node)].z(), 0.4 * kRadius - blur);
  for (const auto node : mesh.groups.at("accessible"))
    EXPECT_LT(mesh.nodes[static_cast<std::size_t>(node)].z(), 0.4 * kRadius + blur);
  EXPECT_GT(fixed.size(), 10U);
}

TEST(NearestTriangle, IsTheOneThatAPointLiesIn) {
  mesh::TriangleSurface ball = sphere(kRadius, 2);
  ball.triangles.insert(ball.triangles.begin(), {0, 0, 1});  // without area
  const NearestTriangle nearest(ball);
  for (std::size_t t = 1; t < ball.triangles.size(); ++t) {
    const Eigen::Vector3d x = centreOf(ball, ball.triangles[t]);
    EXPECT_EQ(nearest.to(x), t);
    EXPECT_EQ(nearest.to(1.2 * x), t);
  }
  ball.triangles.resize(1);
  EXPECT_REFUSED(NearestTriangle(ball).to({0, 0, 0}), "no triangle has an area");
}

TEST(PaintedGroups, HoldAnOrganWhoseTrianglesStay) {
  const TemporaryFolder folder;
  writePainted(folder / "ball.obj", sphere(kRadius, 3));
  ImportOptions options;
  options.fixed = {parseFixedRule("group:cap")};
  const ImportedOrgan organ = importOrgan(folder / "ball.obj", options);
  expectCapHeld(organ.mesh, 0.01);
  ASSERT_EQ(organ.notes.size(), 1U) << "the group of the whole surface is not worth a word";
  EXPECT_EQ(organ.notes[0], "groups of the file that are not kept: skin");
}

TEST(PaintedGroups, StayThroughRepairRemeshingAndScale) {
  const TemporaryFolder folder;
  mesh::TriangleSurface spoiled = sphere(kRadius, 4);
  cutHole(spoiled, {0.2, 0.1, -1}, 0.2 * kRadius);
  pierce(spoiled, {1, 0.2, 0}, 0.1 * kRadius);
  writePainted(folder / "scan.obj", spoiled, 1e-3);
  for (const bool remeshed : {false, true}) {
    ImportOptions options;
    options.repair = true;
    options.scale = 1e-3;
    if (remeshed) options.sizes.surface = 0.01;
    options.fixed = {parseFixedRule("group:cap")};
    expectCapHeld(importOrgan(folder / "scan.obj", options).mesh, 0.015);
  }
}

TEST(PaintedGroups, TheNameFixedHoldsWithoutARule) {
  const TemporaryFolder folder;
  writePainted(folder / "ball.obj", sphere(kRadius, 3));
  std::string text = mesh::test::contentOf(folder / "ball.obj");
  text.replace(text.find("usemtl cap"), 10, "usemtl fixed");
  expectCapHeld(importOrgan(folder.write("held.obj", text), {}).mesh, 0.01);
}

TEST(PaintedGroups, ADryRunKnowsThem) {
  const TemporaryFolder folder;
  writePainted(folder / "ball.obj", sphere(kRadius, 3));
  ImportOptions options;
  options.fixed = {parseFixedRule("group:cap")};
  const Preview preview = previewOrgan(folder / "ball.obj", options);
  const double whole = preview.held.area + preview.touchable.area + preview.neither.area;
  EXPECT_NEAR(preview.held.area / whole, 0.3, 0.05);  // of a ball, above 0.4 of its radius
}

TEST(PaintedGroups, AnUnknownOneIsRefusedBeforeTheFilling) {
  const TemporaryFolder folder;
  writePainted(folder / "ball.obj", sphere(kRadius, 3));
  ImportOptions options;
  options.fixed = {parseFixedRule("group:rim")};
  bool estimated = false;
  options.say = [&](const std::string&) { estimated = true; };
  EXPECT_REFUSED(importOrgan(folder / "ball.obj", options),
                 "--fixed group:rim: there is no such group; the file has body, cap, skin");
  EXPECT_FALSE(estimated);
}

}  // namespace
}  // namespace palpate::organ::test
