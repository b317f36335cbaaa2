// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/ccx_deck.h"

#include <gtest/gtest.h>

#include <set>

#include "box_model.h"
#include "parsed_deck.h"

namespace palpate::query::test {
namespace {

struct Written {
  BoxModel box;
  Anchor anchor{anchorNear(box.model, {0.083, 0.031, 0.06})};
  FullSolution truth{box.solve(anchor, {0.001, -0.002, -0.004})};
  std::string text{ccxDeck(box.organ, truth, "a touch\n*STEP of evil", 4)};
  ParsedDeck deck{text};
};

TEST(CcxNumber, FitsItsFieldAndKeepsTwelveDigits) {
  for (const double value : {0.0, 1.0, -1.0 / 3.0, 160e3, 0.48, -1.2345678901234567e-7, 9.87654321098765e-101,
                             -0.012345678901234567, 1.7976931348623157e308}) {
    const std::string text = ccxNumber(value);
    EXPECT_LE(text.size(), 20U) << text;
    EXPECT_NEAR(std::stod(text), value, 1e-12 * std::abs(value)) << text;
  }
}

TEST(CcxDeck, HoldsTheMeshUnderItsOwnNumbers) {
  const Written w;
  const auto& nodes = w.deck.under.at("*NODE,NSET=ALL");
  ASSERT_EQ(nodes.size(), w.box.organ.mesh.node_tag.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    EXPECT_EQ(std::stoll(nodes[i].at(0)), w.box.organ.mesh.node_tag[i]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(std::stod(nodes[i].at(1 + axis)), w.box.organ.mesh.nodes[3 * i + axis], 1e-13);
  }
  const auto& tetrahedra = w.deck.under.at("*ELEMENT,TYPE=C3D4,ELSET=BODY");
  ASSERT_EQ(tetrahedra.size(), w.box.organ.mesh.tetrahedron_tag.size());
  for (std::size_t e = 0; e < tetrahedra.size(); ++e) {
    EXPECT_EQ(std::stoll(tetrahedra[e].at(0)), w.box.organ.mesh.tetrahedron_tag[e]);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto node = static_cast<std::size_t>(w.box.organ.mesh.tetrahedra[4 * e + k]);
      EXPECT_EQ(std::stoll(tetrahedra[e].at(1 + k)), w.box.organ.mesh.node_tag[node]);
    }
  }
}

TEST(CcxDeck, HoldsMaterialAndSupports) {
  const Written w;
  const auto& elastic = w.deck.under.at("*ELASTIC");
  EXPECT_EQ(std::stod(elastic.at(0).at(0)), 1e5);
  EXPECT_EQ(std::stod(elastic.at(0).at(1)), 0.4);
  std::set<std::int64_t> held, expected;
  for (const auto& line : w.deck.under.at("*NSET,NSET=HELD")) {
    EXPECT_LE(line.size(), 16U);
    for (const auto& field : line) held.insert(std::stoll(field));
  }
  for (int j = 0; j < BoxMesh::kNy; ++j)
    for (int k = 0; k < BoxMesh::kNz; ++k) expected.insert(BoxMesh::number(0, j, k));
  EXPECT_EQ(held, expected);
  EXPECT_EQ(w.deck.under.at("*BOUNDARY").at(0), (ParsedDeck::Fields{"HELD", "1", "3"}));
}

TEST(CcxDeck, SpreadsTheForceOverThePatch) {
  const Written w;
  Vec3 sum = Vec3::Zero();
  std::map<std::int64_t, double> along_z;
  for (const auto& line : w.deck.under.at("*CLOAD")) {
    const int axis = std::stoi(line.at(1)) - 1;
    sum[axis] += std::stod(line.at(2));
    if (axis == 2) along_z[std::stoll(line.at(0))] = std::stod(line.at(2));
  }
  const Vec3& f = w.truth.state.force;
  EXPECT_LT((sum - f).norm(), 1e-12 * f.norm());
  ASSERT_EQ(along_z.size(), w.truth.patch.nodes.size());
  for (std::size_t i = 0; i < w.truth.patch.nodes.size(); ++i) {
    const std::int64_t number = w.box.organ.mesh.node_tag[static_cast<std::size_t>(w.truth.patch.nodes[i])];
    EXPECT_NEAR(along_z.at(number), w.truth.patch.weights[i] * f[2], 1e-12 * f.norm());
  }
}

TEST(CcxDeck, IsOneNonlinearStepThatPrintsAllNodesOnce) {
  const Written w;
  EXPECT_EQ(w.deck.keywords,
            (std::vector<std::string>{
                "*HEADING", "*NODE,NSET=ALL", "*ELEMENT,TYPE=C3D4,ELSET=BODY", "*MATERIAL,NAME=BODY",
                "*ELASTIC", "*SOLID SECTION,ELSET=BODY,MATERIAL=BODY", "*NSET,NSET=HELD", "*BOUNDARY",
                "*STEP,NLGEOM,INC=1000", "*STATIC", "*CONTROLS,PARAMETERS=FIELD", "*CLOAD",
                "*NODE PRINT,NSET=ALL,FREQUENCY=1000", "*END STEP"}));
  EXPECT_EQ(std::stod(w.deck.under.at("*STATIC").at(0).at(0)), 0.25);
  std::istringstream in(w.text);
  for (std::string line; std::getline(in, line);) {
    EXPECT_LE(line.size(), 132U);
    if (line[0] == '*') continue;
    for (const auto& field : ParsedDeck::cut(line)) EXPECT_LE(field.size(), 20U) << line;
  }
}

TEST(CcxDeck, RefusesNumbersThatCalculixCannotTake) {
  Written w;
  w.box.organ.mesh.tetrahedron_tag[3] = 0;
  EXPECT_EQ(errorOf([&] { (void)ccxDeck(w.box.organ, w.truth, "", 1); }),
            "CalculiX takes the numbers 1 to 999999999, but the mesh has a tetrahedron 0");
  w.box.organ.mesh.node_tag[3] = 1'000'000'000;
  EXPECT_EQ(errorOf([&] { (void)ccxDeck(w.box.organ, w.truth, "", 1); }),
            "CalculiX takes the numbers 1 to 999999999, but the mesh has a node 1000000000");
}

TEST(CcxDeck, HasASectionForEachRegionAndAnElementForEachSpring) {
  const BoxModel box{"stvk", 1, BoxCase::kRegionAndSprings};
  const FullSolution truth = box.solve(anchorNear(box.model, {0.083, 0.031, 0.06}), {0.001, -0.002, -0.004});
  const std::string text = ccxDeck(box.organ, truth, "", 1);
  const ParsedDeck deck(text);
  std::set<std::int64_t> stiff, expected;
  for (const auto& line : deck.under.at("*ELSET,ELSET=REGION2"))
    for (const auto& field : line) stiff.insert(std::stoll(field));
  const mesh::TetMesh mesh = BoxMesh::make();
  for (const std::int32_t e : mesh.regions.at("nodule"))
    expected.insert(mesh.tetrahedron_tags[static_cast<std::size_t>(e)]);
  EXPECT_EQ(stiff, expected);
  EXPECT_EQ(std::stod(deck.under.at("*ELASTIC").at(0).at(0)), 1e5);
  EXPECT_EQ(std::stod(deck.under.at("*ELASTIC").at(0).at(1)), 0.4);
  EXPECT_NE(text.find("*MATERIAL,NAME=REGION2\n*HYPERFOAM,N=2\n"), std::string::npos);
  EXPECT_NE(text.find("*SOLID SECTION,ELSET=REGION2,MATERIAL=REGION2\n"), std::string::npos);
  double total = 0.0;
  for (std::size_t s = 0; s < box.organ.mesh.spring_node.size(); ++s) {
    const std::string set = "SPRING" + std::to_string(s + 1) + "_3";
    EXPECT_EQ(std::stoll(deck.under.at("*ELEMENT,TYPE=SPRING1,ELSET=" + set).at(0).at(1)),
              box.organ.mesh.node_tag[static_cast<std::size_t>(box.organ.mesh.spring_node[s])]);
    EXPECT_EQ(deck.under.at("*SPRING,ELSET=" + set).at(0).at(0), "3");
    total += std::stod(deck.under.at("*SPRING,ELSET=" + set).at(1).at(0));
  }
  EXPECT_NEAR(total, BoxCase::kBed * 0.1 * 0.06, 0.21 * total);  // but for the clamped edge
  EXPECT_GT(total, 0.0);
}

}  // namespace
}  // namespace palpate::query::test
