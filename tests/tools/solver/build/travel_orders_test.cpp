// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/travel_orders.h"

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "tools/mesh/box_mesh.h"

namespace palpate::solver {
namespace {

mesh::TetMesh heldBlock() {
  mesh::TetMesh box = mesh::makeBox({0.06, 0.05, 0.04}, {6, 5, 5});
  box.groups.clear();
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(box.nodes.size()); ++node)
    if (box.nodes[static_cast<std::size_t>(node)].z() < 1e-9) box.groups["fixed"].push_back(node);
  return box;
}

Case softCase() {
  Case c;
  c.mesh = "block";
  c.law = "stable-neo-hookean";
  c.nu = 0.4;
  c.patch_radius = 0.012;
  return c;
}

/// A block that is held below.
class Travel : public ::testing::Test {
 protected:
  Travel() { factor_.factorize(Eigen::VectorXd::Zero(3 * setup_.model.nodeCount())); }

  [[nodiscard]] TravelOrders ordersOf(double travel,
                                      std::span<const SeriesOrders> tried = kTravelOrders) const {
    return ordersFor(travel, {}, setup_, factor_, {.workers = 2, .scratch = ".", .quiet = true}, tried);
  }

  const SolverSetup setup_{softCase(), heldBlock()};
  Cholesky factor_{setup_.model};
};

TEST_F(Travel, TakesTheLeastOrdersWithWhichMostTouchesAreWithinTheDomain) {
  const TravelOrders near = ordersOf(0.001), far = ordersOf(0.0055);
  EXPECT_EQ(near.orders.fields, 3);
  EXPECT_EQ(near.orders.answer, 6);
  EXPECT_EQ(near.places, 16);
  EXPECT_EQ(far.travel, 0.0055);
  EXPECT_GT(far.orders.fields, 3);
  for (const TravelOrders& found : {near, far}) {
    EXPECT_GE(found.within, kEnoughTouches);
    EXPECT_EQ(found.tried.back().within, found.within);
    for (std::size_t i = 0; i + 1 < found.tried.size(); ++i)
      EXPECT_LT(found.tried[i].within, kEnoughTouches) << i << " would have been enough";
  }
}

TEST_F(Travel, WhereNoneAreEnoughTakesThoseWithWhichMostAre) {
  const TravelOrders most = ordersOf(0.015);
  EXPECT_GT(most.within, 0.0);
  EXPECT_LT(most.within, kEnoughTouches);
  EXPECT_EQ(most.tried.size(), kTravelOrders.size());
  for (const TriedOrders& tried : most.tried) EXPECT_LE(tried.within, most.within + 0.01);
}

TEST_F(Travel, ATighterErrorShrinksTheDomain) {
  DomainCriteria tight;
  tight.answer_error = tight.field_error = 1e-3;
  const std::vector<SeriesOrders> third{{3, 6}};
  const BuildOptions options{.workers = 2, .scratch = ".", .quiet = true};
  const double usual = ordersFor(0.0055, {}, setup_, factor_, options, third).within;
  EXPECT_LT(ordersFor(0.0055, tight, setup_, factor_, options, third).within, usual);
}

}  // namespace
}  // namespace palpate::solver
