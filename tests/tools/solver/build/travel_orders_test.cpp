// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/travel_orders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

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
    return ordersFor(travel, setup_, factor_, {.workers = 2, .scratch = ".", .quiet = true}, tried);
  }

  const SolverSetup setup_{softCase(), heldBlock()};
  Cholesky factor_{setup_.model};
};

TEST_F(Travel, TakesTheLeastOrdersWithWhichHalfOfThePlacesReachIt) {
  const TravelOrders near = ordersOf(0.001), far = ordersOf(0.0055);
  EXPECT_EQ(near.orders.fields, 3);
  EXPECT_EQ(near.orders.answer, 6);
  EXPECT_EQ(near.places, 16);
  EXPECT_EQ(far.travel, 0.0055);
  EXPECT_GT(far.orders.fields, 3);
  for (const TravelOrders& found : {near, far}) EXPECT_GE(2 * found.reaching, found.places);
  const auto chosen = std::find_if(kTravelOrders.begin(), kTravelOrders.end(), [&](const SeriesOrders& o) {
    return o.fields == far.orders.fields && o.answer == far.orders.answer;
  });
  const TravelOrders less = ordersOf(0.0055, {kTravelOrders.begin(), chosen});
  EXPECT_LT(2 * less.reaching, less.places) << "the entries before it are not enough";
}

TEST_F(Travel, WhereNoneAreEnoughTakesThoseWithWhichMostDo) {
  const TravelOrders most = ordersOf(0.010), none = ordersOf(kLargestRadius);
  EXPECT_GT(most.reaching, 0);
  EXPECT_LT(2 * most.reaching, most.places);
  EXPECT_EQ(most.orders.answer, 8);
  EXPECT_EQ(none.reaching, 0);
  EXPECT_EQ(none.orders.fields, 3) << "more would cost and give nothing";
}

}  // namespace
}  // namespace palpate::solver
