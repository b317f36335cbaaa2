// SPDX-License-Identifier: Apache-2.0
// An independent program solves our deck: CalculiX 2.20, which has both laws under NLGEOM.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <tuple>

#include "box_model.h"
#include "palpate/testing/run_program.h"
#include "tools/examine/query/ccx_deck.h"
#include "tools/program/write_file.h"

namespace palpate::query::test {
namespace {

/// The displacements that CalculiX printed, by node number. Fails the test when a node comes twice.
std::map<std::int64_t, Vec3> printedBy(const std::filesystem::path& dat) {
  std::map<std::int64_t, Vec3> u;
  std::ifstream in(dat);
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::int64_t node = 0;
    Vec3 value;
    if (!(fields >> node >> value[0] >> value[1] >> value[2])) continue;
    EXPECT_TRUE(u.emplace(node, value).second) << "node " << node << " was printed twice";
  }
  return u;
}

void expectTheSameOfCalculix(const BoxModel& box) {
  const Vec3 d(0.003, -0.004, -0.012);
  const FullSolution truth = box.solve(anchorNear(box.model, {0.083, 0.031, 0.06}), d);
  program::writeFile(box.folder / "deck.inp", ccxDeck(box.organ, truth, "validation", 1));
  const std::string folder = (box.folder / "").string();
  ASSERT_EQ(std::system(("cd '" + folder + "' && ccx -i deck >ccx.log 2>&1").c_str()), 0);

  const auto printed = printedBy(box.folder / "deck.dat");
  ASSERT_EQ(printed.size(), box.organ.mesh.node_tag.size());
  for (std::size_t i = 0; i < box.organ.mesh.node_tag.size(); ++i) {
    const Vec3 u = truth.state.u.segment<3>(3 * static_cast<Eigen::Index>(i));
    EXPECT_LT((printed.at(box.organ.mesh.node_tag[i]) - u).norm(), 1e-5 * d.norm())
        << "node " << box.organ.mesh.node_tag[i];
  }
  // The case is a nonlinear one, or the comparison would show little.
  const FullSolution small = box.solve(anchorNear(box.model, {0.083, 0.031, 0.06}), 1e-3 * d);
  EXPECT_GT((truth.state.u - 1e3 * small.state.u).cwiseAbs().maxCoeff(), 0.01 * d.norm());
}

/// A law, and elements of four nodes (C3D4) or of ten (C3D10).
class CalculixValidation : public ::testing::TestWithParam<std::tuple<std::string_view, int>> {
 protected:
  static BoxModel box(BoxCase::Kind kind) {
    const auto& [law, element_order] = GetParam();
    return BoxModel{std::string(law), element_order, kind};
  }
};
INSTANTIATE_TEST_SUITE_P(Body, CalculixValidation,
                         ::testing::Combine(::testing::ValuesIn(kLaws), ::testing::Values(1, 2)),
                         [](const auto& test) {
                           std::string name(std::get<0>(test.param));
                           std::erase(name, '-');
                           return name + (std::get<1>(test.param) == 1 ? "Linear" : "Quadratic");
                         });

TEST_P(CalculixValidation, EveryNodeMovesAsInNewton) {
  if (!palpate::testing::isInstalled("ccx")) GTEST_SKIP() << "ccx (package calculix-ccx) is missing";
  expectTheSameOfCalculix(box(BoxCase::kPlain));
}

TEST_P(CalculixValidation, EveryNodeOfABodyWithAStiffRegionOnSpringsMovesAsInNewton) {
  if (!palpate::testing::isInstalled("ccx")) GTEST_SKIP() << "ccx (package calculix-ccx) is missing";
  expectTheSameOfCalculix(box(BoxCase::kRegionAndSprings));
}

}  // namespace
}  // namespace palpate::query::test
