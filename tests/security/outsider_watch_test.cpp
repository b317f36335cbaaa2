// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/outsider_watch.h"

#include <gtest/gtest.h>

#include <thread>

#include "authority_folder.h"
#include "palpate/idl/topics.h"
#include "palpate/idl/writer.h"
#include "palpate/testing/test_domain.h"

namespace palpate::dds {
namespace {

using namespace std::chrono_literals;

// Another participant of the same authority, which has no endpoint yet: what DDS shows of it is what it shows of one whose
// handshake is not over.
class OutsiderWatchTest : public ::testing::Test {
 protected:
  // All that is said until `seconds` after now, by the clock that the watch is told.
  [[nodiscard]] std::vector<std::string> after(std::chrono::seconds seconds) {
    std::vector<std::string> lines;
    for (int i = 0; i < 50 && lines.empty(); ++i, std::this_thread::sleep_for(10ms))
      lines = watch_.poll(now_ + seconds);
    return lines;
  }

  const palpate::testing::AuthorityFolder authority_;
  const Participant participant_{palpate::testing::exclusiveDomain(),
                                 Identity::load(authority_.of("server"))};
  const Participant other_{palpate::testing::exclusiveDomain(), Identity::load(authority_.of("driver"))};
  OutsiderWatch watch_{participant_, 3s};
  const OutsiderWatch::Clock::time_point now_ = OutsiderWatch::Clock::now();
};

TEST_F(OutsiderWatchTest, OneThatShowsNoTopicIsToldOnceAndWhenItShowsOne) {
  EXPECT_TRUE(after(0s).empty());
  EXPECT_TRUE(after(2s).empty());
  const std::vector<std::string> told = after(4s);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].rfind("participant " + other_.guid(), 0), 0U) << told[0];
  EXPECT_NE(
      told[0].find(" shows no topic: it is not let in (no identity of this authority, an expired or a forged "
                   "one), does not let us in, has none, or its handshake is not over"),
      std::string::npos)
      << told[0];
  EXPECT_TRUE(after(8s).empty());
  const Writer<ServerStatus> writer(other_);
  const std::vector<std::string> corrected = after(9s);
  ASSERT_EQ(corrected.size(), 1U);
  EXPECT_EQ(corrected[0].rfind("participant " + other_.guid(), 0), 0U) << corrected[0];
  EXPECT_NE(corrected[0].find(" shows topics now: it is let in"), std::string::npos) << corrected[0];
}

TEST_F(OutsiderWatchTest, OneThatShowsATopicInTimeIsNotTold) {
  EXPECT_TRUE(after(0s).empty());
  const Writer<ServerStatus> writer(other_);
  EXPECT_TRUE(after(2s).empty());
  EXPECT_TRUE(after(8s).empty());
}

}  // namespace
}  // namespace palpate::dds
