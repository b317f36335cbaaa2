// SPDX-License-Identifier: Apache-2.0
#include "simulated_hours.h"

#include <gtest/gtest.h>

#include "palpate/testing/synthetic_model.h"

namespace palpate::proof {
namespace {

std::shared_ptr<const MetaModel> organ() {
  const testing::TemporaryFile file("hours.h5");
  testing::writeSyntheticModel(file.path());
  return std::make_shared<const MetaModel>(MetaModel::load(file.path()));
}

std::vector<SimulatedRow> simulated(SimulatedOptions options) {
  options.sessions = 3;
  options.sessions_a_row = 1;
  return simulateHours(organ(), options);
}

TEST(SimulatedHours, LaterSessionsHaveTheSameForcesToTheBit) {
  const auto rows = simulated({});
  ASSERT_EQ(rows.size(), 3U);
  for (const SimulatedRow& row : rows) {
    EXPECT_TRUE(row.holds()) << row.not_finite << ' ' << row.beyond_limit << ' ' << row.differing << ' '
                             << row.out_of_step << ' ' << row.faults << ' ' << row.lost << ' '
                             << row.allocations;
    EXPECT_EQ(row.ticks, kSessionTicks);
    EXPECT_GT(row.in_contact, row.ticks / 10) << "they do press";
    EXPECT_GT(row.largest_force, 0.1);
  }
}

TEST(SimulatedHours, FindASessionThatDiffersByAHair) {
  const auto rows = simulated({.nudged_session = 2});
  EXPECT_EQ(rows[1].differing, 0U);
  EXPECT_GT(rows[2].differing, 0U);
  EXPECT_FALSE(rows[2].holds());
}

TEST(SimulatedHours, FindATickThatAllocates) {
  const auto rows = simulated({.leaking_session = 2});
  EXPECT_EQ(rows[1].allocations, 0U);
  EXPECT_GE(rows[2].allocations, kSessionTicks) << "malloc beneath operator new counts too";
}

}  // namespace
}  // namespace palpate::proof
