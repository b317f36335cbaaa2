// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/boundary_groups.h"

#include <algorithm>
#include <tuple>

#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/topology.h"

namespace palpate::organ::test {
namespace {

using mesh::TetMesh;
using Nodes = std::vector<std::int32_t>;

// 5 x 5 x 5 nodes, 98 of them on the surface, 25 on each side.
TetMesh grouped(const std::string& rule, TetMesh box = mesh::makeBox({1, 1, 1}, {5, 5, 5})) {
  setBoundaryGroups(box, mesh::boundaryOf(box), {parseFixedRule(rule)});
  return box;
}

double highest(const TetMesh& box, const std::string& group) {
  double z = -1;
  for (const auto node : box.groups.at(group)) z = std::max(z, box.nodes[static_cast<std::size_t>(node)].z());
  return z;
}

TEST(FixedRule, LowestNodesAreAFractionOfTheSurfaceNodes) {
  const TetMesh box = grouped("lowest-z:0.25");
  EXPECT_EQ(box.groups.at("fixed").size(), 25U);  // 24.5, rounded
  EXPECT_EQ(box.groups.at("accessible").size(), 73U);
  EXPECT_EQ(highest(box, "fixed"), 0);
}

TEST(FixedRule, BoxHoldsTheSurfaceNodesWithin) {
  const TetMesh box = grouped("box:-1,-1,-1,2,2,0.25");
  EXPECT_EQ(box.groups.at("fixed").size(), 25U + 16U);  // not the nine inner nodes of the second layer
  EXPECT_EQ(highest(box, "fixed"), 0.25);
}

TEST(FixedRule, GroupIsTakenAsItIs) {
  TetMesh box = mesh::makeBox({1, 1, 1}, {5, 5, 5});
  box.groups["vessel"] = {0, 1, 5, 62};
  box.groups["other"] = {3};
  box = grouped("group:vessel", box);
  EXPECT_EQ(box.groups.at("fixed"), (Nodes{0, 1, 5, 62}));
  EXPECT_EQ(box.groups.at("accessible").size(), 95U);  // node 62 is the centre
  EXPECT_EQ(box.groups.size(), 2U);
}

TEST(FixedRule, WithoutARuleTheFilesOwnGroupStays) {
  TetMesh box = mesh::makeBox({1, 1, 1}, {5, 5, 5});
  box.groups["fixed"] = {0, 1, 5};
  setBoundaryGroups(box, mesh::boundaryOf(box), {});
  EXPECT_EQ(box.groups.at("fixed"), (Nodes{0, 1, 5}));
  box.groups.clear();
  setBoundaryGroups(box, mesh::boundaryOf(box), {});
  EXPECT_FALSE(box.groups.contains("fixed"));
  EXPECT_EQ(box.groups.at("accessible").size(), 98U);
}

TEST(FixedRule, WhatTheFileCallsAccessibleStaysExceptWhatIsFixed) {
  TetMesh box = mesh::makeBox({1, 1, 1}, {5, 5, 5});
  box.groups["accessible"] = {1, 2, 62, 124};
  box.groups["fixed"] = {0, 1, 5};
  setBoundaryGroups(box, mesh::boundaryOf(box), {});
  EXPECT_EQ(box.groups.at("accessible"), (Nodes{2, 124}));  // node 62 is the centre
  box = grouped("lowest-z:0.25", box);
  EXPECT_EQ(box.groups.at("accessible"), (Nodes{124}));
  EXPECT_REFUSED(grouped("box:0,0,0.9,1,1,1", box), "group 'accessible': none of its 1 nodes");
}

TEST(FixedRule, GroupsThatAreDroppedOrReplacedAreNamed) {
  TetMesh box = mesh::makeBox({1, 1, 1}, {5, 5, 5});
  for (const char* name : {"accessible", "fixed", "organ", "vessel"}) box.groups[name] = {0, 1, 5};
  using Names = std::vector<std::string>;
  EXPECT_EQ(groupsNotKept(box, {}), (Names{"organ", "vessel"}));
  EXPECT_EQ(groupsNotKept(box, {parseFixedRule("group:vessel")}), (Names{"fixed", "organ"}));
  EXPECT_EQ(groupsNotKept(box, {parseFixedRule("group:fixed")}), (Names{"organ", "vessel"}));
  EXPECT_EQ(groupsNotKept(box, {parseFixedRule("lowest-z:0.25")}), (Names{"fixed", "organ", "vessel"}));
  box.groups["organ"].resize(box.nodes.size());
  EXPECT_EQ(groupsNotKept(box, {}), (Names{"vessel"}));
}

TEST(FixedRule, TissuesStayButNoneIsCalledFixed) {
  TetMesh box = mesh::makeBox({1, 1, 1}, {5, 5, 5});
  box.regions = {{"vessel", {0, 1}}, {"fixed", {0, 1, 2}}};
  box.groups = {{"vessel", {0, 1, 5}}, {"fixed", {0, 1, 5}}};
  EXPECT_TRUE(groupsNotKept(box, {}).empty());
  setBoundaryGroups(box, mesh::boundaryOf(box), {});
  EXPECT_EQ(box.regions, (std::map<std::string, Nodes>{{"vessel", {0, 1}}}));
  EXPECT_EQ(box.groups.size(), 2U);
}

TEST(FixedRule, UnknownGroupListsThoseThereAre) {
  TetMesh box = mesh::makeBox({1, 1, 1}, {5, 5, 5});
  EXPECT_REFUSED(grouped("group:vesel", box), "group:vesel", "the file has none");
  box.groups["vessel"] = {0, 1, 5};
  box.groups["skin"] = {3};
  EXPECT_REFUSED(grouped("group:vesel", box), "no such group", "the file has skin, vessel");
}

TEST(FixedRule, RefusesWhatDoesNotHoldTheOrgan) {
  TetMesh box = mesh::makeBox({1, 1, 1}, {5, 5, 5});
  box.groups["line"] = {0, 1, 2, 4};
  EXPECT_REFUSED(grouped("group:line", box), "group 'fixed': 4 nodes lie on one line");
  EXPECT_REFUSED(grouped("box:5,5,5,6,6,6"), "0 nodes do not hold");
  EXPECT_REFUSED(grouped("lowest-z:0.02"), "2 nodes do not hold");
  EXPECT_REFUSED(grouped("box:0,0,0,1,1,1"), "all 98 surface nodes are fixed");
}

TEST(FixedRule, ASideHoldsWhatFacesItMoreThanAnyOther) {
  for (const auto& [side, axis, end] : {std::tuple{"-x", 0, 0.0}, {"+y", 1, 1.0}, {"-z", 2, 0.0}}) {
    const TetMesh box = grouped(side);
    ASSERT_EQ(box.groups.at("fixed").size(), 25U) << side;
    for (const auto node : box.groups.at("fixed"))
      EXPECT_EQ(box.nodes[static_cast<std::size_t>(node)][axis], end) << side;
  }
}

TEST(FixedRule, ANormalHoldsWhatFacesItWithinItsAngle) {
  EXPECT_EQ(grouped("normal:0,0,-3").groups.at("fixed").size(), 25U);
  EXPECT_EQ(grouped("normal:0,-1,-1,46").groups.at("fixed").size(), 45U);  // two sides share an edge
  EXPECT_REFUSED(grouped("normal:0,-1,-1,44"), "0 nodes do not hold");
}

TEST(FixedRule, SeveralUnite) {
  TetMesh box = mesh::makeBox({1, 1, 1}, {5, 5, 5});
  box.groups["vessel"] = {62};
  const FixedRules rules{parseFixedRule("-x"), parseFixedRule("+x"), parseFixedRule("group:vessel")};
  EXPECT_EQ(fixedNodes(box, mesh::boundaryOf(box), rules).size(), 51U);
  EXPECT_EQ(groupsNotKept(box, {parseFixedRule("-x")}), std::vector<std::string>{"vessel"});
  EXPECT_TRUE(groupsNotKept(box, rules).empty());
  EXPECT_REFUSED(
      fixedNodes(box, mesh::boundaryOf(box), {parseFixedRule("-x"), parseFixedRule("box:5,5,5,6,6,6")}),
      "--fixed box:5,5,5,6,6,6 holds no node");
}

// No tool comes into a cavity, and what lies lowest is sought outside.
TEST(FixedRule, CavitiesAreNeitherHeldByPlacesNorAccessible) {
  TetMesh box = mesh::makeBox({1, 1, 1}, {6, 6, 6});
  std::vector<std::array<std::int32_t, 4>> kept;
  for (const auto& t : box.tetrahedra) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const auto node : t) middle += box.nodes[static_cast<std::size_t>(node)] / 4;
    if ((middle - Eigen::Vector3d(0.5, 0.5, 0.5)).cwiseAbs().maxCoeff() > 0.1) kept.push_back(t);
  }
  ASSERT_LT(kept.size(), box.tetrahedra.size());
  box.tetrahedra = kept;
  const auto boundary = mesh::boundaryOf(box);
  EXPECT_EQ(boundary.nodes.size(), 216U - 64 + 8);
  setBoundaryGroups(box, boundary, {parseFixedRule("+z")});
  EXPECT_EQ(box.groups.at("fixed").size(), 36U);  // the cavity's floor faces up, too
  EXPECT_EQ(box.groups.at("accessible").size(), 216U - 64 - 36);
}

TEST(FixedRule, RefusesNormalsThatAreNone) {
  EXPECT_REFUSED(parseFixedRule("normal:0,0"), "three numbers, and degrees if wanted, not 2");
  EXPECT_REFUSED(parseFixedRule("normal:0,0,0"), "the normal has no length");
  EXPECT_REFUSED(parseFixedRule("normal:0,0,1,0"), "above 0 and at most 90 degrees");
  EXPECT_REFUSED(parseFixedRule("normal:0,0,1,91"), "above 0 and at most 90 degrees");
  EXPECT_REFUSED(parseFixedRule("normal:0,0,up"), "'up' is not a number");
  for (const char* wrong : {"x", "-w", "+x,", "--x"})
    EXPECT_REFUSED(parseFixedRule(wrong), "a side such as -x");
}

TEST(FixedRule, RefusesTextThatIsNoRule) {
  for (const char* wrong :
       {"lowest-z:0", "lowest-z:1", "lowest-z:-0.1", "lowest-z:0.1,0.2", "lowest-z:nan"}) {
    EXPECT_REFUSED(parseFixedRule(wrong), wrong);
  }
  EXPECT_REFUSED(parseFixedRule("lowest-z:some"), "'some' is not a number");
  EXPECT_REFUSED(parseFixedRule("lowest-z:"), "'' is not a number");
  EXPECT_REFUSED(parseFixedRule("box:0,0,0,1,1"), "six numbers, not 5");
  EXPECT_REFUSED(parseFixedRule("box:0,0,0,1,1,x"), "'x' is not a number");
  EXPECT_REFUSED(parseFixedRule("box:0,0,0,1,1,-1"), "second corner");
  for (const char* wrong : {"", "group:", "group", "box", "lowest-z", "highest-z:0.1"}) {
    EXPECT_REFUSED(parseFixedRule(wrong), "expected group:NAME, lowest-z:FRACTION, box:");
  }
}

}  // namespace
}  // namespace palpate::organ::test
