// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/rival_book.h"

#include <gtest/gtest.h>

namespace palpate::server {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr dds::WriterId kWriter = 5;

class RivalBookTest : public ::testing::Test {
 protected:
  void hearForce(std::uint32_t server_id, std::uint64_t session, std::int64_t now_ns) {
    dds::ToolForce force{};
    force.server_id = server_id;
    force.session = session;
    book_.heardForce(force, kWriter, now_ns);
  }
  void hearStatus(std::uint32_t server_id, std::uint64_t session, std::uint32_t state, bool answers_any,
                  std::int64_t now_ns) {
    dds::ServerStatus status{};
    status.server_id = server_id;
    status.session = session;
    status.state = state;
    status.answers_any = answers_any;
    dds::assignText(status.host, "bench");
    dds::assignText(status.model_id, "abc");
    status.pid = 7;
    book_.heardStatus(status, kWriter, now_ns);
  }

  Facts facts_;  // server 0, answers any
  RivalBook book_{facts_};
};

TEST_F(RivalBookTest, AServerOfTheSameIdIsARivalAtItsFirstForce) {
  hearForce(0, 9, kSecond);
  ASSERT_EQ(book_.rivals(kSecond).size(), 1U);
  EXPECT_TRUE(book_.rivals(kSecond)[0].answers());
  EXPECT_EQ(describe(book_.rivals(kSecond)[0]),
            "server 0, session 0000000000000009, which sends forces but no status");
}

TEST_F(RivalBookTest, OfTwoIdsTheyAreRivalsIfBothAnswerAnyPose) {
  hearStatus(1, 9, dds::server_state::kRunning, true, kSecond);
  ASSERT_EQ(book_.rivals(kSecond).size(), 1U);
  EXPECT_EQ(describe(book_.rivals(kSecond)[0]),
            "server 1, session 0000000000000009, on bench, pid 7, model abc");
  hearStatus(1, 9, dds::server_state::kRunning, false, kSecond);
  EXPECT_TRUE(book_.rivals(kSecond).empty());
  facts_.answers_any = false;
  hearStatus(1, 9, dds::server_state::kRunning, true, kSecond);
  EXPECT_TRUE(book_.rivals(kSecond).empty());
}

TEST_F(RivalBookTest, NamesFromTheWireMoveNoTerminal) {
  OtherServer other;
  other.status_writer = kWriter;
  other.host = {'a', '\x1b', '[', '2', 'J', '\n', 'b'};
  EXPECT_NE(describe(other).find("on a?[2J?b, pid"), std::string::npos) << describe(other);
}

TEST_F(RivalBookTest, ForcesOfAnotherIdHaveTimeToSayWhatTheyAnswer) {
  hearForce(1, 9, kSecond);
  EXPECT_TRUE(book_.rivals(kSecond).empty());
  hearForce(1, 9, 2 * kSecond);
  EXPECT_EQ(book_.rivals(2 * kSecond).size(), 1U) << "no status came";
  hearStatus(1, 9, dds::server_state::kRunning, false, 2 * kSecond);
  EXPECT_TRUE(book_.rivals(2 * kSecond).empty());
}

TEST_F(RivalBookTest, ForcesOfToolsThatAreNotServedAreNobodysAnswer) {
  dds::ToolForce force{};
  force.tool_id = 4;
  book_.heardForce(force, kWriter, kSecond);
  EXPECT_TRUE(book_.rivals(kSecond).empty());
}

TEST_F(RivalBookTest, AServerThatStopsOrFallsSilentIsNoRival) {
  hearStatus(0, 9, dds::server_state::kRunning, true, kSecond);
  hearStatus(0, 9, dds::server_state::kStopping, true, kSecond);
  EXPECT_TRUE(book_.rivals(kSecond).empty());
  hearStatus(0, 8, dds::server_state::kRunning, true, kSecond);
  EXPECT_EQ(book_.rivals(kSecond + RivalBook::kGoneNs).size(), 1U);
  EXPECT_TRUE(book_.rivals(kSecond + RivalBook::kGoneNs + 1).empty());
}

TEST_F(RivalBookTest, OneThatStartsIsToldOnce) {
  EXPECT_FALSE(book_.takeStarter());
  hearStatus(0, 9, dds::server_state::kStarting, true, kSecond);
  EXPECT_TRUE(book_.takeStarter());
  EXPECT_FALSE(book_.takeStarter());
  EXPECT_FALSE(book_.rivals(kSecond)[0].answers());
}

TEST_F(RivalBookTest, InventedSessionsFillNothingAndHideNobodyForLong) {
  for (std::uint64_t session = 1; session <= 100'000; ++session) hearForce(0, session, kSecond);
  EXPECT_EQ(book_.rivals(kSecond).size(), RivalBook::kMost);
  const std::int64_t later_ns = kSecond + RivalBook::kGoneNs + 1;
  hearStatus(0, 200'000, dds::server_state::kRunning, true, later_ns);
  ASSERT_EQ(book_.rivals(later_ns).size(), 1U);
  EXPECT_EQ(book_.rivals(later_ns)[0].session, 200'000U);
}

}  // namespace
}  // namespace palpate::server
