// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "palpate/core/status_flags.h"
#include "palpate/idl/types.h"

namespace palpate::dds {
namespace {

TEST(Flags, OnTheWireAreThoseOfTheEngine) {
  EXPECT_EQ(flag::kInContact, palpate::kInContact);
  EXPECT_EQ(flag::kNonFinitePose, palpate::kNonFinitePose);
  EXPECT_EQ(flag::kNonUnitQuaternion, palpate::kNonUnitQuaternion);
  EXPECT_EQ(flag::kStalePose, palpate::kStalePose);
  EXPECT_EQ(flag::kBeyondDomain, palpate::kBeyondDomain);
  EXPECT_EQ(flag::kForceLimited, palpate::kForceLimited);
  EXPECT_EQ(flag::kNotAccessible, palpate::kNotAccessible);
  EXPECT_EQ(flag::kRamping, palpate::kRamping);
  EXPECT_EQ(flag::kShuttingDown, palpate::kShuttingDown);
  EXPECT_EQ(flag::kNonFiniteForce, palpate::kNonFiniteForce);
  EXPECT_EQ(flag::kPoseOutOfOrder, palpate::kPoseOutOfOrder);
  EXPECT_EQ(flag::kForceRateLimited, palpate::kForceRateLimited);
  EXPECT_EQ(flag::kPoseJump, palpate::kPoseJump);
  EXPECT_EQ(flag::kTwoPublishers, palpate::kTwoPublishers);
  EXPECT_EQ(flag::kUnknownTool, palpate::kUnknownTool);
  EXPECT_EQ(flag::kToolNotConfigured, palpate::kToolNotConfigured);
  EXPECT_EQ(flag::kTickOverrun, palpate::kTickOverrun);
}

TEST(Flags, ToolStatesAreThoseOfTheEngine) {
  EXPECT_EQ(tool_state::kFree, static_cast<std::uint32_t>(ContactState::kFree));
  EXPECT_EQ(tool_state::kStick, static_cast<std::uint32_t>(ContactState::kStick));
  EXPECT_EQ(tool_state::kSlide, static_cast<std::uint32_t>(ContactState::kSlide));
}

TEST(Flags, AreDistinctSingleBits) {
  std::uint32_t seen = 0;
  for (const std::uint32_t bit :
       {flag::kInContact, flag::kNonFinitePose, flag::kNonUnitQuaternion, flag::kStalePose,
        flag::kBeyondDomain, flag::kForceLimited, flag::kNotAccessible, flag::kRamping, flag::kShuttingDown,
        flag::kNonFiniteForce, flag::kPoseOutOfOrder, flag::kForceRateLimited, flag::kPoseJump,
        flag::kTwoPublishers, flag::kUnknownTool, flag::kToolNotConfigured, flag::kTickOverrun}) {
    EXPECT_EQ(bit & (bit - 1), 0U) << bit;
    EXPECT_EQ(seen & bit, 0U) << bit;
    seen |= bit;
  }
}

}  // namespace
}  // namespace palpate::dds
