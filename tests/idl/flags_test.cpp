// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/base/status_flags.h"
#include "palpate/idl/types.h"

namespace palpate::dds {
namespace {

TEST(Flags, OnTheWireAreThoseOfTheEngine) {
  ASSERT_EQ(flag::kWords.size(), kStatusFlags.size());
  for (std::size_t i = 0; i < kStatusFlags.size(); ++i) {
    EXPECT_EQ(flag::kWords[i].first, kStatusFlags[i].bit);
    EXPECT_STREQ(flag::kWords[i].second, kStatusFlags[i].word);
  }
  EXPECT_EQ(flag::kInContact, palpate_FLAG_IN_CONTACT);
  EXPECT_EQ(palpate::kStalePose, palpate_FLAG_STALE_POSE);
}

TEST(Flags, ToolStatesAreThoseOfTheEngine) {
  EXPECT_EQ(tool_state::kFree, static_cast<std::uint32_t>(ContactState::kFree));
  EXPECT_EQ(tool_state::kStick, static_cast<std::uint32_t>(ContactState::kStick));
  EXPECT_EQ(tool_state::kSlide, static_cast<std::uint32_t>(ContactState::kSlide));
}

TEST(Flags, AreDistinctSingleBits) {
  std::uint32_t seen = 0;
  ASSERT_FALSE(flag::kWords.empty());
  for (const auto& [bit, word] : flag::kWords) {
    EXPECT_EQ(bit & (bit - 1), 0U) << bit;
    EXPECT_EQ(seen & bit, 0U) << bit;
    seen |= bit;
  }
}

}  // namespace
}  // namespace palpate::dds
