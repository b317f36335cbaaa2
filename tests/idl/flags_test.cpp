// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "palpate/idl/types.h"

namespace palpate::dds {
namespace {

TEST(Flags, AreDistinctSingleBits) {
  std::uint32_t seen = 0;
  for (const std::uint32_t bit :
       {flag::kInContact, flag::kNonFinitePose, flag::kNonUnitQuaternion, flag::kStalePose,
        flag::kBeyondDomain, flag::kForceLimited, flag::kNotAccessible, flag::kRamping, flag::kShuttingDown,
        flag::kNonFiniteForce, flag::kPoseOutOfOrder}) {
    EXPECT_EQ(bit & (bit - 1), 0U) << bit;
    EXPECT_EQ(seen & bit, 0U) << bit;
    seen |= bit;
  }
}

}  // namespace
}  // namespace palpate::dds
