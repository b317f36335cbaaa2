// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/case_material.h"

#include <gtest/gtest.h>

#include <functional>

#include "tools/mesh/box_mesh.h"
#include "tools/mesh/quadratic.h"
#include "tools/solver/fem/newton.h"

namespace palpate::solver {
namespace {

constexpr double kX = 0.03, kY = 0.02, kZ = 0.02;  // m

/// Groups "bottom", "top" and "pins"; regions "left" and "right", which share a tetrahedron, and "tip".
mesh::TetMesh block() {
  mesh::TetMesh mesh = mesh::makeBox({kX, kY, kZ}, {4, 3, 3});
  mesh.groups.clear();
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(mesh.nodes.size()); ++i) {
    const Vec3& X = mesh.nodes[static_cast<std::size_t>(i)];
    if (X.z() < 1e-9) mesh.groups["bottom"].push_back(i);
    if (X.z() > kZ - 1e-9) mesh.groups["top"].push_back(i);
    if (X.x() < 1e-9 && X.y() < 1e-9) mesh.groups["pins"].push_back(i);
  }
  for (std::int32_t t = 0; t < 72; ++t) {
    if (t <= 20) mesh.regions["left"].push_back(t);
    if (t >= 20 && t < 50) mesh.regions["right"].push_back(t);
    if (t >= 50) mesh.regions["tip"].push_back(t);
  }
  return mesh;
}

Case withRegions(std::vector<RegionCase> regions) {
  Case c;
  c.E = 5e3;
  c.nu = 0.45;
  c.law = "stable-neo-hookean";
  c.regions = std::move(regions);
  return c;
}

Case onSprings(const std::string& group, double stiffness) {
  Case c;
  c.springs.push_back({group, stiffness, "case.toml:4: spring.group"});
  return c;
}

std::string errorOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const CaseError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CaseMaterial, OfARegionIsItsOwnWithTheRestOfTheBodys) {
  const mesh::TetMesh mesh = block();
  const Material material =
      materialOf(withRegions({{"left", 70e3, {}, {}, "here"}, {"tip", 60e3, 0.3, "stvk", "there"}}), mesh);
  EXPECT_NO_THROW(material.check(mesh.tetrahedra.size()));
  EXPECT_EQ(material.of(0).E, 70e3);
  EXPECT_EQ(material.of(0).nu, 0.45);
  EXPECT_EQ(material.lawIn(0).index(), lawOf("stable-neo-hookean").index());
  EXPECT_EQ(material.of(30).E, 5e3);
  EXPECT_EQ(material.of(50).E, 60e3);
  EXPECT_EQ(material.of(50).nu, 0.3);
  EXPECT_EQ(material.lawIn(50).index(), lawOf("stvk").index());
}

TEST(CaseMaterial, WithoutRegionsIsOne) {
  const Material material = materialOf(withRegions({}), block());
  EXPECT_TRUE(material.regions.empty());
  EXPECT_EQ(material.of(7).E, 5e3);
}

TEST(CaseMaterial, RefusesAGroupThatIsNotThereAndListsThoseThatAre) {
  EXPECT_EQ(errorOf([] {
              (void)materialOf(withRegions({{"nodule", 1e3, {}, {}, "case.toml:9: region.group"}}), block());
            }),
            "case.toml:9: region.group = \"nodule\" is no group of tetrahedra of the mesh (there are: left, "
            "right, tip)");
  EXPECT_EQ(
      errorOf([] { (void)springsOf(onSprings("bed", 1.0), block()); }),
      "case.toml:4: spring.group = \"bed\" is no group of nodes of the mesh (there are: bottom, pins, top)");
}

TEST(CaseMaterial, RefusesRegionsThatOverlapByName) {
  EXPECT_EQ(
      errorOf([] {
        (void)materialOf(withRegions({{"left", 1e3, {}, {}, "a"}, {"right", 1e3, {}, {}, "b"}}), block());
      }),
      "b = \"right\" overlaps region \"left\" in tetrahedron " +
          std::to_string(block().tetrahedron_tags[20]));
}

TEST(CaseMaterial, RefusesSpringsWithoutAFace) {
  EXPECT_EQ(errorOf([] { (void)springsOf(onSprings("pins", 1.0), block()); }),
            "case.toml:4: spring.group = \"pins\" holds no face of the boundary: springs need an area");
}

TEST(CaseMaterial, SpringsAddUpToStiffnessTimesAreaAndClampedNodesHaveNone) {
  for (const mesh::TetMesh& mesh : {block(), mesh::quadraticOf(block())}) {
    Case c = onSprings("bottom", 1e6);
    c.fixed = "pins";
    double total = 0.0, clamped = 0.0;
    for (const Spring& spring : springsOf(c, mesh)) {
      total += spring.stiffness;
      if (mesh.nodes[static_cast<std::size_t>(spring.node)].head<2>().norm() < 1e-9) clamped += 1.0;
    }
    EXPECT_EQ(clamped, 0.0);
    c.fixed = "none";
    double whole = 0.0;
    for (const Spring& spring : springsOf(c, mesh)) whole += spring.stiffness;
    EXPECT_NEAR(whole, 1e6 * kX * kY, 1e-9 * whole);
    EXPECT_LE(total, whole);
  }
}

// k times the depth of the bed is the pressure; the block itself gives by k kZ / E of that, 2e-5.
TEST(CaseMaterial, AStiffBlockOnABedSinksByForceOverStiffnessTimesArea) {
  constexpr double k = 1e6, force = 2.0;
  for (const mesh::TetMesh& mesh : {block(), mesh::quadraticOf(block())}) {
    const FeModel model(mesh.nodes, {mesh.tetrahedra, mesh.midsides}, {}, {{1e9, 0.3}},
                        springsOf(onSprings("bottom", k), mesh));
    Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * model.nodeCount());
    for (const Spring& part : springsOf(onSprings("top", 1.0), mesh))
      load[3 * part.node + 2] = -force * part.stiffness / (kX * kY);
    NewtonSolver newton(model);
    const NewtonResult result = newton.solveLoad(load, {});
    const double depth = force / (k * kX * kY);
    for (const std::int32_t node : mesh.groups.at("bottom"))
      EXPECT_NEAR(result.u[3 * node + 2], -depth, 2e-4 * depth);
    EXPECT_NEAR(model.energy(result.u), 0.5 * force * depth, 1e-3 * force * depth);
  }
}

}  // namespace
}  // namespace palpate::solver
