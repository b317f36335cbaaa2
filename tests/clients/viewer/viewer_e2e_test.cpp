// SPDX-License-Identifier: Apache-2.0
// palpate-viewer between a real server and pages played by the test.
#include <algorithm>
#include <csignal>
#include <mutex>

#include "palpate/client/tool_client.h"
#include "palpate/idl/reader.h"
#include "viewer_fixture.h"

namespace palpate::testing {
namespace {

constexpr double kDepth = 0.003;

double forceOn(const TestPage& page, bool mine = true) {
  for (const TestPage::Tool& tool : page.tools)
    if ((tool.mine == 1) == mine) return sizeOf(tool.force);
  return 0.0;
}

// Counts the server's answers beside the viewer.
class AnswersOnTheWire {
 public:
  explicit AnswersOnTheWire(const std::string& domain)
      : participant_(static_cast<std::uint32_t>(std::stoul(domain))),
        reader_(participant_, &AnswersOnTheWire::onForce, this) {}

  // Number of answers with stamps in this interval of this machine's clock.
  [[nodiscard]] std::size_t between(double from_us, double to_us) {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::count_if(
        stamps_us_.begin(), stamps_us_.end(), [&](double t_us) { return t_us >= from_us && t_us <= to_us; }));
  }

 private:
  static void onForce(dds::ReaderView<dds::ToolForce> reader, void* context) noexcept {
    auto& self = *static_cast<AnswersOnTheWire*>(context);
    std::array<dds::ToolForce, dds::kMaxTake> forces;
    const std::size_t count = reader.take(forces);
    const std::lock_guard lock(self.mutex_);
    for (std::size_t i = 0; i < count; ++i)
      self.stamps_us_.push_back(static_cast<double>(forces[i].stamp_ns) * 1e-3);
  }

  std::mutex mutex_;
  std::vector<double> stamps_us_;
  dds::Participant participant_;
  dds::Reader<dds::ToolForce> reader_;
};

TEST_F(ViewerEndToEnd, APageSeesTheOrganAndFeelsItPushBack) {
  const auto page = openServedPage();
  EXPECT_EQ(page->texts["hello"]["protocol"], 2);
  EXPECT_EQ(page->texts["mesh"]["nodes"], 642);
  const auto regions = page->texts["mesh"]["regions"];
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_EQ(regions[1]["name"], "nodule");
  EXPECT_EQ(regions[1]["youngs_modulus"], 1.6e6);
  EXPECT_EQ(at<std::uint32_t>(page->mesh, 16), 2U);
  EXPECT_EQ(page->texts["status"]["tools"], 4);
  EXPECT_LT(page->frame_size, 60'000U);

  const auto tool = grab(*page);
  ASSERT_TRUE(tool["granted"]) << tool;
  EXPECT_EQ(tool["tool_id"], 3) << "the highest first: a device has 0";
  EXPECT_TRUE(page->press(kDepth, seconds(10), [&] { return forceOn(*page) > 0.5; }));
  EXPECT_TRUE(page->press(kDepth, seconds(10), [&] { return page->largest_displacement > 1e-3; }));
  ASSERT_FALSE(page->tools.empty());
  EXPECT_GT(page->tools[0].force[2], 0.5F) << "the organ pushes the tool out, upwards";
  EXPECT_NEAR(page->tools[0].tip[2], static_cast<double>(page->top[2]) + 0.005 - kDepth, 1e-4);
  EXPECT_NE(page->tools[0].flags & dds::flag::kInContact, 0U);

  page->texts.erase("tool");
  page->client.say({{"type", "release"}});
  EXPECT_TRUE(page->listen(seconds(5), [&] { return page->has("tool"); }));
  EXPECT_EQ(page->texts["tool"]["message"], "released");
  EXPECT_TRUE(page->listen(seconds(5), [&] { return page->tools.empty(); })) << "no page holds it now";
  EXPECT_TRUE(page->listen(seconds(5), [&] { return page->largest_displacement < 1e-5; }))
      << "the dent is gone";
}

TEST_F(ViewerEndToEnd, EveryAnswerOfTheServerReachesTheStripChart) {
  const auto page = openHoldingPage();
  page->press(kDepth, milliseconds(500));
  page->answers.clear();
  AnswersOnTheWire wire(domain_);
  page->press(kDepth, seconds(2));
  ASSERT_FALSE(page->answers.empty());
  const std::size_t made = wire.between(page->answers.front().t_us, page->answers.back().t_us);
  ASSERT_GT(made, 100U);
  // DDS keeps the newest answer only, so a busy machine loses some on either way; a viewer that thins loses half.
  EXPECT_GT(3 * page->answers.size(), 2 * made);
  for (std::size_t i = 1; i < page->answers.size(); ++i)
    ASSERT_GT(page->answers[i].t_us, page->answers[i - 1].t_us) << "answer " << i;
}

TEST_F(ViewerEndToEnd, TwoPagesDriveTwoToolsAndSeeEachOther) {
  startServer();
  startViewer();
  const auto first = openPage();
  const auto second = openPage();
  ASSERT_TRUE(first->connect());
  ASSERT_TRUE(second->connect());
  ASSERT_EQ(grab(*first)["tool_id"], 3);
  ASSERT_EQ(grab(*second)["tool_id"], 2);
  EXPECT_TRUE(first->press(kDepth, seconds(10), [&] {
    second->listen(milliseconds(5));
    return forceOn(*second, false) > 0.3;
  })) << "the second page sees the first one's tool";
}

TEST_F(ViewerEndToEnd, AToolThatAnotherProgramSendsIsNotGivenAway) {
  startServer();
  startViewer({"--tools", "3,2"});
  const auto page = openPage();
  ASSERT_TRUE(page->connect());
  const dds::Participant participant(static_cast<std::uint32_t>(std::stoul(domain_)));
  client::ToolClient device(participant, 3);
  ASSERT_TRUE(device.waitForServer(seconds(10)));
  const device::Point away{{0.0, 0.0, 0.3}};
  for (int i = 0; i < 300; ++i) {
    device.publish(away);
    page->listen(milliseconds(2));
  }
  EXPECT_EQ(grab(*page)["tool_id"], 2);
}

TEST_F(ViewerEndToEnd, APageThatLeavesGivesItsToolBackAndTheForceEnds) {
  startServer();
  startViewer({"--tools", "1"});
  auto first = openPage();
  const auto second = openPage();
  ASSERT_TRUE(first->connect());
  ASSERT_TRUE(second->connect());
  ASSERT_EQ(grab(*first)["tool_id"], 1);
  ASSERT_TRUE(first->press(kDepth, seconds(10), [&] { return forceOn(*first) > 0.5; }));
  const auto refused = grab(*second);
  EXPECT_FALSE(refused["granted"]);
  EXPECT_NE(refused["message"].get<std::string>().find("in use"), std::string::npos);
  first.reset();
  EXPECT_TRUE(second->listen(seconds(5), [&] { return second->tools.empty(); }))
      << "the server took it to zero";
  second->listen(milliseconds(200));  // a tool rests until the server has let it go
  EXPECT_EQ(grab(*second)["tool_id"], 1);
}

TEST_F(ViewerEndToEnd, APageThatFreezesLosesItsTool) {
  const auto page = openHoldingPage();
  ASSERT_TRUE(page->press(kDepth, seconds(10), [&] { return forceOn(*page) > 0.5; }));
  page->texts.erase("tool");
  EXPECT_TRUE(page->listen(seconds(5), [&] { return page->has("tool"); })) << "no targets any more";
  EXPECT_FALSE(page->texts["tool"]["granted"]);
  EXPECT_TRUE(page->listen(seconds(5), [&] { return page->tools.empty(); }));
}

TEST_F(ViewerEndToEnd, AStifferOrganPushesBackHarderAndAWrongValueIsNamed) {
  const auto page = openHoldingPage();
  page->press(0.001, milliseconds(800));
  const double before = forceOn(*page);
  ASSERT_GT(before, 0.1);
  page->client.say({{"type", "set"}, {"request", 1}, {"youngs_factor", 2.0}});
  EXPECT_TRUE(page->press(0.001, seconds(10), [&] { return page->has("parameters"); }));
  EXPECT_TRUE(page->texts["parameters"]["accepted"]) << page->texts["parameters"];
  EXPECT_TRUE(page->press(0.001, seconds(10), [&] { return forceOn(*page) > 1.9 * before; })) << before;
  EXPECT_NEAR(forceOn(*page), 2.0 * before, 0.1 * before);
  page->texts.erase("parameters");
  page->client.say({{"type", "set"}, {"request", 2}, {"friction", 5.0}});
  EXPECT_TRUE(page->listen(seconds(5), [&] { return page->has("parameters"); }));
  EXPECT_FALSE(page->texts["parameters"]["accepted"]);
  EXPECT_EQ(page->texts["parameters"]["request"], 2);
  EXPECT_NE(page->texts["parameters"]["message"].get<std::string>().find("friction"), std::string::npos);
}

TEST_F(ViewerEndToEnd, OutlivesItsServerAndShowsTheNextOnesOrgan) {
  startViewer();
  const auto page = openPage();
  ASSERT_EQ(page->client.status(), 101);
  ASSERT_TRUE(page->listen(seconds(5), [&] { return page->has("state"); }));
  EXPECT_EQ(page->texts["state"]["text"], "waiting for a server on DDS domain " + domain_);
  startServer();
  ASSERT_TRUE(page->connect());
  server_->signal(SIGKILL);
  EXPECT_TRUE(page->listen(seconds(20), [&] { return page->texts["state"]["server"] == "gone"; }));
  startServer(2);
  EXPECT_TRUE(page->listen(seconds(30), [&] { return page->serving() && page->frame_revision == 2; }));
  EXPECT_EQ(page->texts["mesh"]["nodes"], 162);
  EXPECT_EQ(at<std::uint32_t>(page->mesh, 4), 162U);
  ASSERT_TRUE(grab(*page)["granted"]);
  EXPECT_TRUE(page->press(kDepth, seconds(10), [&] { return forceOn(*page) > 0.3; }));
  server_->signal(SIGTERM);
  EXPECT_TRUE(page->listen(seconds(20), [&] { return page->texts["state"]["server"] == "gone"; }));
}

TEST_F(ViewerEndToEnd, OfTwoServersOneIsPressedAndTheOtherNamed) {
  server_ = newServer(3, {"--server-id", "4", "--addressed-only"});
  startViewer();
  auto page = openPage();
  ASSERT_TRUE(page->connect());
  const auto other = newServer(2, {"--server-id", "5", "--addressed-only"});
  const auto named = [&] { return page->texts["state"]["others"].get<std::string>(); };
  EXPECT_TRUE(page->listen(seconds(10), [&] { return !named().empty(); }));
  EXPECT_NE(named().find("server 5"), std::string::npos) << named();
  EXPECT_TRUE(page->serving());
  EXPECT_TRUE(grab(*page)["granted"]);
  EXPECT_TRUE(page->press(kDepth, seconds(10), [&] { return forceOn(*page) > 0.5; }));
  EXPECT_EQ(page->texts["status"]["server_id"], 4);
  EXPECT_EQ(page->texts["mesh"]["nodes"], 642);
  server_->signal(SIGKILL);
  EXPECT_TRUE(
      page->listen(seconds(10), [&] { return page->serving() && page->texts["mesh"]["nodes"] == 162; }));
}

TEST_F(ViewerEndToEnd, TheForceOfAServerThatWasKilledGoesBeforeTheServerIsGivenUp) {
  const auto page = openHoldingPage();
  ASSERT_TRUE(page->press(kDepth, seconds(10), [&] { return forceOn(*page) > 0.5; }));
  server_->signal(SIGKILL);
  const auto gone = [&] { return page->texts["state"]["server"] == "gone"; };
  page->press(kDepth, seconds(20), [&] { return page->tools.empty() || gone(); });
  EXPECT_TRUE(page->tools.empty());
  EXPECT_FALSE(gone()) << "half a second without answers, not two and a half without a status";
}

TEST_F(ViewerEndToEnd, ASlowPageGetsFewerFramesAndNoOldOnes) {
  startServer();
  startViewer();
  const auto slow = openPage();
  const auto other = openPage();
  slow->acknowledges = false;
  ASSERT_TRUE(slow->connect());
  ASSERT_TRUE(other->connect());
  // Nothing touches the organ, so its field comes once a second.
  ASSERT_TRUE(slow->listen(seconds(10), [&] { return slow->frame_seqs.size() == 2; }));
  slow->listen(seconds(3));
  EXPECT_EQ(slow->frame_seqs.size(), 2U) << "no third one before the first is acknowledged";
  EXPECT_TRUE(goesOn(*other));
  const std::uint64_t seen = other->surface_seq;
  slow->client.say({{"type", "ping"}, {"t0", 1.5}});
  ASSERT_TRUE(slow->listen(seconds(5), [&] { return slow->has("pong"); }));
  EXPECT_EQ(slow->texts["pong"]["t0"], 1.5);
  slow->acknowledges = true;
  slow->client.say({{"type", "ack"}, {"seq", 2}});
  std::vector<std::uint8_t> frame;
  while (frame.empty()) {
    const WsMessage message = slow->client.receive(seconds(5));
    ASSERT_TRUE(message.kind == WsMessage::Kind::kText || message.kind == WsMessage::Kind::kBinary);
    if (message.kind == WsMessage::Kind::kBinary) frame = message.bytes;
  }
  EXPECT_EQ(at<std::uint32_t>(frame, 4), 3U);
  EXPECT_GE(at<std::uint64_t>(frame, 32), seen) << "not older than what the other page has seen long since";
}

TEST_F(ViewerEndToEnd, APageMayAskForFewerFramesOrNone) {
  const auto page = openServedPage();
  page->client.say({{"type", "rate"}, {"hz", 0}});
  page->listen(milliseconds(300));
  const std::size_t before = page->frame_seqs.size();
  page->listen(seconds(1));
  EXPECT_LE(page->frame_seqs.size(), before + 1);
  page->client.say({{"type", "rate"}, {"hz", 10}});
  ASSERT_TRUE(goesOn(*page));
  const double start_us = page->sent_us;
  const std::size_t first = page->frame_seqs.size();
  ASSERT_TRUE(page->listen(seconds(20), [&] { return page->frame_seqs.size() >= first + 10; }));
  EXPECT_GT(page->sent_us - start_us, 0.85e6) << "ten frames at 10 Hz, the first perhaps half a period early";
}

}  // namespace
}  // namespace palpate::testing
