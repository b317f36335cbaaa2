// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/boundary_groups.h"

#include <algorithm>

#include "helpers.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/topology.h"

namespace palpate::organ::test {
namespace {

using mesh::TetMesh;
using Nodes = std::vector<std::int32_t>;

// 5 x 5 x 5 nodes, 98 of them on the surface, 25 on each side.
TetMesh grouped(const std::string& rule, TetMesh box = mesh::makeBox({1, 1, 1}, {5, 5, 5})) {
  setBoundaryGroups(box, mesh::boundaryOf(box), parseFixedRule(rule));
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
  EXPECT_EQ(groupsNotKept(box, parseFixedRule("group:vessel")), (Names{"fixed", "organ"}));
  EXPECT_EQ(groupsNotKept(box, parseFixedRule("group:fixed")), (Names{"organ", "vessel"}));
  EXPECT_EQ(groupsNotKept(box, parseFixedRule("lowest-z:0.25")), (Names{"fixed", "organ", "vessel"}));
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
    EXPECT_REFUSED(parseFixedRule(wrong), "expected group:NAME, lowest-z:FRACTION or box:");
  }
}

}  // namespace
}  // namespace palpate::organ::test
