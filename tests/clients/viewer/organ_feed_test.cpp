// SPDX-License-Identifier: Apache-2.0
#include "organ_feed.h"

#include <gtest/gtest.h>

#include <limits>

#include "feed_of_many_servers.h"

namespace palpate::viewer {
namespace {

TEST_F(FeedOfManyServers, TheServerThatIsHeldIsNotMixedWithAnotherOfTheSameIdAndModel) {
  const Run held{0, 7, "aa", 0}, other{0, 8, "aa", 0};
  sayAll(held);
  for (int i = 1; i <= 20; ++i) {
    sayStatus(other);
    saySurface(other, 0.5);
    sayField(other, 1000);
    sayParameters(other, 900e3);
    sayForce(held, 0.372);
    sayForce(other, 8.614);
    (void)until([&] { return shownForce() != 0.0; });
    ASSERT_EQ(shownForce(), 0.372) << i;
  }
  EXPECT_FALSE(until([&] { return feed_.field() != nullptr; })) << "a field of the other";
  sayField(held, 3);
  ASSERT_TRUE(until([&] { return feed_.field() != nullptr; }));
  EXPECT_EQ(feed_.field()->seq, 3U);
  EXPECT_EQ(feed_.surface()->positions[1][0], 0.1);
  EXPECT_EQ(feed_.parameters()->model_youngs_modulus, 100e3);
  EXPECT_EQ(feed_.watch().session(), 7U);
  EXPECT_EQ(feed_.answers().end(), 20U);
  std::uint64_t place = 0;
  std::vector<AnswerRecord> answers;
  feed_.answers().since(place, 100, answers);
  ASSERT_EQ(answers.size(), 20U);
  for (const float x : answers.back().tip) EXPECT_TRUE(std::isnan(x)) << "nobody sent a pose";
}

TEST_F(FeedOfManyServers, AFloodOfSessionsHidesNoWordOfTheServerThatIsFollowed) {
  const Run held{0, 7};
  sayAll(held);
  for (std::uint64_t session = 100; session < 2100; ++session) sayStatus({3, session});
  const std::uint64_t before = feed_.statusVersion();
  sayStatus(held, dds::server_state::kStopping);
  EXPECT_TRUE(until([&] { return state() == "gone"; }));
  EXPECT_GT(feed_.statusVersion(), before);
}

TEST_F(FeedOfManyServers, PosesForOtherServersKeepNoneOfOursOut) {
  sayAll({0, 7});
  dds::ToolPose pose{};
  pose.tool_id = 1;
  for (pose.server_id = 1; pose.server_id <= 2 * dds::kMaxInstances; ++pose.server_id)
    ASSERT_TRUE(poses_.write(pose));
  pose.server_id = 0;
  ASSERT_TRUE(poses_.write(pose));
  std::vector<std::uint32_t> foreign;
  for (int i = 0; i < 4 && foreign.empty(); ++i) foreign = feed_.poll(rt::monotonicNow(), 0);
  EXPECT_EQ(foreign, std::vector<std::uint32_t>{1});
}

TEST_F(FeedOfManyServers, ThatAnotherServerIsThereIsSaid) {
  sayAll({0, 7});
  EXPECT_EQ(feed_.state(rt::monotonicNow()).others, "");
  sayStatus({5, 8, "bb"});
  ASSERT_TRUE(until([&] { return !feed_.state(rt::monotonicNow()).others.empty(); }));
  EXPECT_EQ(state(), "serving");
  EXPECT_NE(feed_.state(rt::monotonicNow()).text.find("server 5 (bench, process 0)"), std::string::npos);
  sayStatus({5, 8, "bb"}, dds::server_state::kStopping);
  EXPECT_TRUE(until([&] { return feed_.state(rt::monotonicNow()).others.empty(); }));
}

TEST_F(FeedOfManyServers, TheNextServersSurfaceIsKnownThoughItCameOnceBeforeItWasFollowed) {
  const Run first{1, 7, "aa"}, next{2, 8, "bb"};
  sayStatus(first);
  ASSERT_TRUE(until([&] { return state() == "waiting"; }));
  saySurface(first);
  saySurface(next);  // before the first was looked at
  EXPECT_TRUE(until([&] { return state() == "serving"; })) << feed_.state(rt::monotonicNow()).text;
  ASSERT_NE(feed_.surface(), nullptr);
  EXPECT_EQ(feed_.surface()->model_id, "aa");
  sayStatus(first, dds::server_state::kStopping);
  sayStatus(next);
  EXPECT_TRUE(until([&] { return feed_.surface()->model_id == "bb" && state() == "serving"; }));
}

TEST_F(FeedOfManyServers, AServerThatTakesAnotherModelIsFollowedWithItsNewSurface) {
  const Run before{1, 7, "aa"}, after{1, 7, "bb"};
  sayAll(before);
  const std::uint32_t revision = feed_.revision();
  saySurface(after, 0.2);
  sayStatus(after);
  ASSERT_TRUE(until([&] { return feed_.surface()->model_id == "bb" && state() == "serving"; }));
  EXPECT_EQ(feed_.revision(), revision + 1);
  EXPECT_EQ(feed_.surface()->positions[1][0], 0.2);
  sayField(after, 5);
  EXPECT_TRUE(until([&] { return feed_.field() != nullptr && feed_.field()->seq == 5; }));
  sayStatus(before);  // and back
  saySurface(before);
  EXPECT_TRUE(until([&] { return feed_.surface()->model_id == "aa" && state() == "serving"; }));
  EXPECT_EQ(feed_.field(), nullptr) << "what was shown was of the organ before";
}

TEST_F(FeedOfManyServers, OtherServersHoweverManyDoNotHideTheOneThatIsFollowed) {
  const Run held{1, 7, "aa", 500};
  sayAll(held);
  for (std::uint32_t i = 0; i < 3 * Surfaces::kMostKept; ++i) {
    saySurface({2, 100 + i, "cc", i});
    sayStatus({2, 100 + i, "cc", i});
    (void)feed_.poll(rt::monotonicNow(), 0);
  }
  EXPECT_FALSE(until([&] {
    sayStatus(held);  // as a server does: one that is silent for long is gone
    return state() != "serving";
  }));
}

TEST_F(FeedOfManyServers, NothingOfARunIsLeftInTheNextRunOfItsServer) {
  const Run run{0, 7}, again{0, 8};
  sayAll(run);
  sayField(run, 3);
  sayForce(run, 0.372);
  ASSERT_TRUE(until([&] { return feed_.field() != nullptr && shownForce() != 0.0; }));
  sayStatus(run, dds::server_state::kStopping);
  sayStatus(again);
  ASSERT_TRUE(until([&] { return feed_.watch().session() == 8U; }));
  EXPECT_EQ(feed_.field(), nullptr);
  EXPECT_EQ(feed_.tool(1, rt::monotonicNow()), nullptr);
  EXPECT_FALSE(feed_.parameters());
  EXPECT_EQ(state(), "waiting") << "for its surface";
  sayForce(run, 0.372);
  EXPECT_FALSE(until([&] { return feed_.tool(1, rt::monotonicNow()) != nullptr; }));
}

TEST_F(FeedOfManyServers, TheNextServersParametersAreKnownThoughTheyCameBeforeItWasFollowed) {
  const Run first{1, 7}, next{2, 8, "bb"};
  sayStatus(first);
  sayParameters(first, 100e3);
  ASSERT_TRUE(until([&] { return feed_.parameters().has_value(); }));
  sayParameters(next, 300e3);
  bool came = false;
  ASSERT_TRUE(until([&] {
    for (const dds::ServerParameters& parameters : feed_.newParameters()) came |= parameters.session == 8;
    return came;
  }));
  ASSERT_TRUE(feed_.parameters());
  EXPECT_EQ(feed_.parameters()->model_youngs_modulus, 100e3);
  sayStatus(first, dds::server_state::kStopping);
  sayStatus(next);
  ASSERT_TRUE(until([&] { return feed_.watch().session() == 8; }));
  ASSERT_TRUE(feed_.parameters());
  EXPECT_EQ(feed_.parameters()->model_youngs_modulus, 300e3);
}

TEST_F(FeedOfManyServers, PosesForAnotherServerTakeNoToolHere) {
  sayAll({3, 7});
  std::vector<std::uint32_t> foreign;
  const auto pose = [&](std::uint32_t server_id, std::uint32_t tool_id) {
    dds::ToolPose message{};
    message.server_id = server_id;
    message.tool_id = tool_id;
    ASSERT_TRUE(poses_.write(message));
  };
  pose(4, 0);
  pose(3, 1);
  pose(dds::kServerAny, 2);
  for (int i = 0; i < 200 && foreign.size() < 2; ++i) {
    for (const std::uint32_t id : feed_.poll(rt::monotonicNow(), 0)) foreign.push_back(id);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  std::sort(foreign.begin(), foreign.end());
  EXPECT_EQ(foreign, (std::vector<std::uint32_t>{1, 2}));
}

TEST_F(FeedOfManyServers, NonFiniteAnswersAndPosesAreNotShown) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  const auto answer = [&](std::uint32_t tool_id, const std::function<void(dds::ToolForce&)>& spoil) {
    dds::ToolForce message{};
    message.session = 7;
    message.tool_id = tool_id;
    message.force[1] = 1.0;
    spoil(message);
    ASSERT_TRUE(forces_.write(message));
  };
  const auto pose = [&](double x) {
    dds::ToolPose message{};
    message.server_id = dds::kServerAny;
    message.tool_id = 3;
    message.position[0] = x;
    ASSERT_TRUE(poses_.write(message));
  };
  for (const double wrong : {nan, -infinity, 1e300, 3e38}) {  // three of the last are no float
    answer(0, [&](dds::ToolForce& f) { f.force[1] = wrong; });
    answer(0, [&](dds::ToolForce& f) { f.stiffness[8] = wrong; });
    answer(1, [&](dds::ToolForce& f) { f.anchor[2] = wrong; });
    answer(1, [&](dds::ToolForce& f) { f.proxy[0] = wrong; });
    answer(2, [&](dds::ToolForce& f) { f.penetration = wrong; });
    answer(2, [&](dds::ToolForce& f) { f.domain_radius = wrong; });
  }
  const auto good = [](dds::ToolForce&) {};
  sayAll({0, 7});
  pose(0.25);
  const auto shown = [&](std::uint32_t id) { return feed_.tool(id, rt::monotonicNow()); };
  ASSERT_TRUE(until([&] {
    answer(3, good);
    return shown(3) != nullptr && shown(3)->tip_known;
  }));
  pose(nan);
  pose(1e300);
  EXPECT_FALSE(until([&] {
    answer(3, good);
    return shown(3) == nullptr || shown(3)->tip[0] != 0.25;
  }));
  std::uint64_t place = 0;
  std::vector<AnswerRecord> answers;
  feed_.answers().since(place, AnswerLog::kCapacity, answers);
  ASSERT_FALSE(answers.empty());
  EXPECT_EQ(answers.back().tip[0], 0.25F);
  for (const std::uint32_t id : {0U, 1U, 2U}) EXPECT_EQ(shown(id), nullptr) << id;
}

TEST_F(FeedOfManyServers, FieldsOfOtherServersDoNotSpendThePace) {
  const Run held{1, 7};
  sayAll(held);
  for (std::uint64_t i = 1; i <= 5; ++i) {
    sayField({1, 8}, i);
    sayField({2, 9, "bb"}, i);
  }
  sayField(held, 77);
  ASSERT_TRUE(until([&] { return feed_.field() != nullptr; }));
  EXPECT_EQ(feed_.field()->seq, 77U);
  EXPECT_EQ(feed_.droppedFields(), 0U);
}

}  // namespace
}  // namespace palpate::viewer
