// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/server_hold.h"

#include <gtest/gtest.h>

namespace palpate::client {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr ServerRun kOne{0, 11};
constexpr ServerRun kTwo{0, 22};
constexpr dds::WriterId kWriter = 5;
constexpr dds::WriterId kOther = 6;

TEST(ServerHold, TheFirstThatAnswersIsHeldOnToAndOthersAreLeftOut) {
  ServerHold hold;
  EXPECT_EQ(hold.address(kSecond), dds::kServerAny);
  EXPECT_EQ(hold.held(), ServerRun{});
  EXPECT_FALSE(hold.takes(kTwo, kOther, kSecond, false)) << "it answers somebody else";
  EXPECT_TRUE(hold.takes(kOne, kWriter, kSecond));
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(hold.takes(kTwo, kOther, kSecond + i));
  EXPECT_EQ(hold.held(), kOne);
  EXPECT_EQ(hold.address(kSecond), 0U);
  EXPECT_EQ(hold.changes(), 1U);
  EXPECT_EQ(hold.leftOut().count, 11U);
  EXPECT_EQ(hold.leftOut().newest, kTwo);
}

TEST(ServerHold, TheNextIsTakenOnlyWhenTheHeldOneIsSilent) {
  ServerHold hold;
  EXPECT_TRUE(hold.takes(kOne, kWriter, kSecond));
  EXPECT_FALSE(hold.takes(kTwo, kOther, kSecond + ServerHold::kSilenceNs));
  EXPECT_TRUE(hold.takes(kTwo, kOther, kSecond + ServerHold::kSilenceNs + 1));
  EXPECT_EQ(hold.held(), kTwo);
  EXPECT_EQ(hold.changes(), 2U);
  EXPECT_FALSE(hold.takes(kOne, kWriter, kSecond + ServerHold::kSilenceNs + 2)) << "it comes back too late";
}

TEST(ServerHold, AFarewellShortensTheSilence) {
  ServerHold hold;
  EXPECT_TRUE(hold.takes(kOne, kWriter, kSecond, true, true));
  EXPECT_FALSE(hold.takes(kTwo, kOther, kSecond + ServerHold::kFarewellNs));
  EXPECT_TRUE(hold.takes(kTwo, kOther, kSecond + ServerHold::kFarewellNs + 1));
}

TEST(ServerHold, WhileNoneAnswersPosesGoToWhomeverWasWanted) {
  ServerHold any, named({3, 0});
  EXPECT_TRUE(any.takes({7, 1}, kWriter, kSecond));
  EXPECT_EQ(any.address(kSecond + 1), 7U);
  EXPECT_EQ(any.address(3 * kSecond), dds::kServerAny);
  EXPECT_EQ(named.address(kSecond), 3U);
  EXPECT_FALSE(named.takes({7, 1}, kWriter, kSecond)) << "not the one that was named";
  EXPECT_TRUE(named.takes({3, 1}, kWriter, kSecond));
}

TEST(ServerHold, ARunThatIsNamedIsHeldFromTheStart) {
  ServerHold hold(kOne);
  EXPECT_EQ(hold.address(kSecond), 0U);
  EXPECT_FALSE(hold.takes(kTwo, kOther, kSecond)) << "it answers first";
  EXPECT_TRUE(hold.takes(kOne, kWriter, kSecond + 1));
  ServerHold another(kOne);
  EXPECT_FALSE(another.takes(kTwo, kOther, 9 * kSecond)) << "nothing was asked so far";
  EXPECT_EQ(another.address(9 * kSecond), 0U);
  EXPECT_TRUE(another.takes(kTwo, kOther, 11 * kSecond)) << "it never answered; the next run of this server";
}

TEST(ServerHold, AnotherWriterInTheSameSessionIsNotTheServer) {
  ServerHold hold;
  EXPECT_TRUE(hold.takes(kOne, kWriter, kSecond));
  EXPECT_FALSE(hold.takes(kOne, kOther, kSecond));
  EXPECT_EQ(hold.leftOut().count, 1U);
}

}  // namespace
}  // namespace palpate::client
