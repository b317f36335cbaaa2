// SPDX-License-Identifier: Apache-2.0
#include "server_watch.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "../small_surface.h"
#include "outward.h"
#include "page_text.h"

namespace palpate::viewer {
namespace {

using nlohmann::json;
constexpr std::int64_t kSecond = 1'000'000'000;

dds::ServerStatus running(std::uint32_t id, const char* model) {
  dds::ServerStatus status{};
  status.server_id = id;
  status.session = 100 + id;
  status.state = dds::server_state::kRunning;
  dds::assignText(status.model_id, model);
  return status;
}

TEST(ServerWatch, SaysWhatIsMissing) {
  ServerWatch watch(7);
  EXPECT_EQ(watch.state(kSecond, "", "").text, "waiting for a server on DDS domain 7");
  EXPECT_EQ(watch.state(kSecond, "", "type differs").name, "mismatch");
  EXPECT_TRUE(watch.saw(running(0, "aa"), kSecond));
  EXPECT_EQ(watch.state(kSecond, "", "").text, "waiting for the organ's surface");
  EXPECT_EQ(watch.state(kSecond, "bb", "").name, "waiting") << "the surface is of another model";
  EXPECT_EQ(watch.state(kSecond, "aa", "").name, "serving");
}

TEST(ServerWatch, OfManyServersTheOneThatIsNamedIsFollowed) {
  ServerWatch watch(7, {3, {}});
  EXPECT_FALSE(watch.saw(running(2, "aa"), kSecond));
  const ServerState waiting = watch.state(kSecond, "aa", "");
  EXPECT_EQ(waiting.name, "waiting");
  EXPECT_NE(waiting.text.find("waiting for server 3 on DDS domain 7; not shown: server 2"), std::string::npos)
      << waiting.text;
  EXPECT_TRUE(watch.saw(running(3, "bb"), kSecond));
  EXPECT_FALSE(watch.saw(running(2, "aa"), 9 * kSecond)) << "the named one is silent: still no other";
  EXPECT_EQ(watch.state(9 * kSecond, "bb", "").name, "gone");
}

TEST(ServerWatch, OfManyServersTheOneWithTheOrganThatIsNamedIsFollowed) {
  ServerWatch watch(7, {dds::kServerAny, 4});
  EXPECT_FALSE(watch.saw(running(2, "aa"), kSecond));
  EXPECT_NE(watch.state(kSecond, "aa", "").text.find("waiting for server with organ 4 on DDS domain 7"),
            std::string::npos);
  dds::ServerStatus with_it = running(3, "bb");
  with_it.organ_id = 4;
  EXPECT_TRUE(watch.saw(with_it, kSecond));
}

TEST(ServerWatch, AServerThatIsSilentIsGoneUntilOneComes) {
  ServerWatch watch(0);
  (void)watch.saw(running(0, "aa"), kSecond);
  EXPECT_EQ(watch.state(3 * kSecond, "aa", "").name, "serving");
  EXPECT_EQ(watch.state(6 * kSecond, "aa", "").name, "gone");
  EXPECT_EQ(watch.state(6 * kSecond, "aa", "").text, "no word from the server since 5 s");
  (void)watch.saw(running(0, "bb"), 7 * kSecond);
  EXPECT_EQ(watch.state(7 * kSecond, "aa", "").name, "waiting");
  EXPECT_EQ(watch.state(7 * kSecond, "bb", "").name, "serving");
  dds::ServerStatus stopping = running(0, "bb");
  stopping.state = dds::server_state::kStopping;
  (void)watch.saw(stopping, 8 * kSecond);
  EXPECT_EQ(watch.state(8 * kSecond, "bb", "").name, "gone");
}

TEST(ServerWatch, OfTwoServersTheFirstIsFollowedWhileItLives) {
  ServerWatch watch(0);
  EXPECT_TRUE(watch.saw(running(1, "aa"), kSecond));
  EXPECT_FALSE(watch.saw(running(2, "bb"), 2 * kSecond));
  EXPECT_STREQ(watch.status()->model_id, "aa");
  EXPECT_TRUE(watch.saw(running(2, "bb"), 5 * kSecond)) << "the first was silent for 4 s";
  EXPECT_STREQ(watch.status()->model_id, "bb");
}

TEST(ServerWatch, ARunOfTheSameServerIsAnotherServerWhileTheFirstLives) {
  ServerWatch watch(0);
  dds::ServerStatus again = running(1, "aa");
  again.session = 999;
  EXPECT_TRUE(watch.saw(running(1, "aa"), kSecond));
  EXPECT_FALSE(watch.saw(again, 2 * kSecond));
  EXPECT_EQ(watch.session(), 101U);
  EXPECT_FALSE(watch.state(2 * kSecond, "aa", "").others.empty());
  dds::ServerStatus stopping = running(1, "aa");
  stopping.state = dds::server_state::kStopping;
  EXPECT_TRUE(watch.saw(stopping, 2 * kSecond));
  EXPECT_TRUE(watch.saw(again, 2 * kSecond));
  EXPECT_EQ(watch.state(2 * kSecond, "aa", "").text, "serving");
}

TEST(ServerWatch, AnotherWriterDoesNotSpeakForTheServerThatIsFollowed) {
  ServerWatch watch(0);
  EXPECT_TRUE(watch.saw(running(1, "aa"), kSecond, 11));
  dds::ServerStatus stopping = running(1, "aa");
  stopping.state = dds::server_state::kStopping;
  EXPECT_FALSE(watch.saw(stopping, 2 * kSecond, 12));
  EXPECT_EQ(watch.state(2 * kSecond, "aa", "").name, "serving");
  EXPECT_TRUE(watch.saw(stopping, 2 * kSecond, 11));
}

TEST(ServerWatch, NamesFromTheWireMoveNoTerminal) {
  ServerWatch watch(0);
  EXPECT_TRUE(watch.saw(running(1, "aa"), kSecond));
  dds::ServerStatus other = running(2, "aa");
  dds::assignText(other.host, "a\x1b[2Jb\n");
  EXPECT_FALSE(watch.saw(other, kSecond));
  EXPECT_EQ(watch.state(kSecond, "aa", "").others, "server 2 (a?[2Jb?, process 0)");
}

TEST(ServerWatch, AServerThatRunsIsTakenBeforeOneThatOnlyStarts) {
  ServerWatch watch(0);
  dds::ServerStatus starting = running(1, "aa");
  starting.state = dds::server_state::kStarting;
  EXPECT_TRUE(watch.saw(starting, kSecond));
  EXPECT_TRUE(watch.saw(running(2, "bb"), kSecond));
  EXPECT_FALSE(watch.saw(starting, kSecond));
}

TEST(ServerWatch, AServerThatStopsIsNeverTaken) {
  ServerWatch watch(0);
  dds::ServerStatus stopping = running(2, "bb");
  stopping.state = dds::server_state::kStopping;
  EXPECT_TRUE(watch.saw(running(1, "aa"), kSecond));
  EXPECT_FALSE(watch.saw(stopping, 9 * kSecond)) << "though the first is gone";
}

TEST(ServerWatch, SessionsWithoutEndAreNotAllKept) {
  ServerWatch watch(0);
  EXPECT_TRUE(watch.saw(running(1, "aa"), kSecond));
  for (std::uint32_t id = 2; id < 5000; ++id) EXPECT_FALSE(watch.saw(running(id, "bb"), kSecond));
  EXPECT_LT(watch.state(kSecond, "aa", "").others.size(), 1500U);
}

TEST(PageText, AStatusNamesFlagsAndSaysNullForNoBound) {
  dds::ServerStatus status = running(3, "aa");
  status.flags = dds::flag::kInContact | dds::flag::kForceLimited;
  status.friction = std::numeric_limits<double>::infinity();
  status.tick_us.p99 = 71.5;
  dds::ServerParameters parameters{};
  parameters.model_youngs_modulus = 160e3;
  parameters.tools[0].now.friction = 0.25;
  parameters.open = true;
  for (dds::ToolParameters& tool : parameters.tools) {
    tool.highest.friction = 0.4;
    tool.highest.force_rate_limit = std::numeric_limits<double>::infinity();
  }
  parameters.tools[2].highest.friction = 0.3;
  const json text = json::parse(statusText(status, parameters, {2, 59.5, 1}));
  EXPECT_EQ(text["type"], "status");
  EXPECT_EQ(text["flags_text"], json::array({"contact", "force-limited"}));
  EXPECT_EQ(text["tick_us"]["p99"], 71.5);
  EXPECT_EQ(text["friction"], 0.25) << "the parameters' word is newer";
  EXPECT_EQ(text["model_youngs_modulus"], 160e3);
  EXPECT_EQ(text["parameters_open"], true);
  EXPECT_EQ(text["limits"]["friction"], json::array({0.0, 0.3})) << "tool 2's: the page sets all";
  EXPECT_TRUE(text["limits"]["force_rate_limit"][1].is_null()) << "no bound";
  EXPECT_EQ(text["viewer"]["pages"], 2);
  EXPECT_TRUE(json::parse(statusText(status, std::nullopt, {}))["friction"].is_null());
  EXPECT_EQ(json::parse(statusText(std::nullopt, std::nullopt, {})).size(), 2U)
      << "no server: the viewer's part";
}

TEST(PageText, AMeshHasItsBox) {
  testing::SmallSurface small;
  const json text = json::parse(meshText(client::checkedSurface(small.message()), 3, 0.005));
  EXPECT_EQ(text["revision"], 3);
  EXPECT_EQ(text["box"], json::parse("[[0,0,0],[0.1,0.1,0.05]]"));
  EXPECT_EQ(text["tip_radius"], 0.005);
  EXPECT_EQ(text["certificate"], "not certified: it is a pyramid") << "the page's line";
}

TEST(PageText, AToolThatIsNotGrantedHasNoNumber) {
  EXPECT_TRUE(json::parse(toolText({false, 0, "all in use"}))["tool_id"].is_null());
  EXPECT_EQ(json::parse(toolText({true, 2, ""}))["tool_id"], 2);
}

TEST(Outward, PointsOffTheNearestPartOfTheSurface) {
  testing::SmallSurface small;
  const Outward outward(client::checkedSurface(small.message()));
  const device::Point above = outward.at({{0.05, 0.05, 0.2}});
  EXPECT_NEAR(above[2], 1.0, 1e-9) << "the apex of a pyramid, by symmetry";
  EXPECT_LT(outward.at({{-1.0, -1.0, -1.0}})[2], 0.0);
  EXPECT_EQ(Outward().at({{1.0, 0.0, 0.0}})[2], 1.0) << "no surface yet";
}

}  // namespace
}  // namespace palpate::viewer
