// SPDX-License-Identifier: Apache-2.0
// Servers that meet on a domain, as processes; and somebody who only poses as one.
#include <gtest/gtest.h>
#include <signal.h>

#include "palpate/testing/run_program.h"
#include "server_fixture.h"

namespace palpate::server::testing {
namespace {

class Rivals : public ServerEndToEnd {
 protected:
  // A further server, which listens as long as one does by default.
  [[nodiscard]] std::unique_ptr<ServerProcess> another(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"--model",  model_.string(), "--domain", std::to_string(domain_),
                                       "--device", "custom"};
    if (std::find(more.begin(), more.end(), "--listen-first") == more.end())
      more.insert(more.end(), {"--listen-first", "0.5"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return std::make_unique<ServerProcess>(arguments);
  }
  [[nodiscard]] dds::ServerStatus status() {
    return client_->waitForStatus([](const auto& s) { return s.state == dds::server_state::kRunning; })
        .value_or(dds::ServerStatus{});
  }
};

using RivalsAtLength = Rivals;

TEST_F(Rivals, ASecondServerEndsBeforeItsFirstForceAndSaysWhoAnswers) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  client_->forget();
  const auto second = another({"--force-limit", "22"});
  EXPECT_EQ(second->waitForExit(), 1);
  const std::string log = second->log();
  for (const std::string& word :
       {std::string("answers there already"), std::string("server 0, session "),
        "pid " + std::to_string(server_->pid()), std::string("GUID "), std::string("--addressed-only")})
    EXPECT_NE(log.find(word), std::string::npos) << word << "\n" << log;
  const auto forces = client_->forces();
  ASSERT_GT(forces.size(), 100U);
  for (const dds::ToolForce& force : forces) {
    EXPECT_EQ(force.session, settled_.session);
    EXPECT_EQ(force.flags & dds::flag::kRivalServer, 0U) << "one that only starts is no rival";
  }

  server_->signal(SIGKILL);
  ASSERT_EQ(server_->waitForExit(), 128 + SIGKILL);
  const auto next = another();
  const auto answer =
      client_->waitFor([&](const auto& f) { return f.session != settled_.session && f.seq > 20; });
  EXPECT_TRUE(answer.has_value()) << "one that was killed keeps nobody from its place: " << next->log();
}

TEST_F(RivalsAtLength, OfTwoServersThatStartAtOnceExactlyOneGoesOn) {
  TestClient client(domain_, 0);
  client.startSending({0.0, 0.0, 1.0});
  const auto one = another();
  const auto two = another();
  const auto answer = client.waitFor([](const auto& force) { return force.seq > 100; });
  ASSERT_TRUE(answer.has_value()) << one->log() << two->log();
  EXPECT_NE(one->running(), two->running()) << one->log() << two->log();
  ServerProcess& loser = one->running() ? *two : *one;
  EXPECT_EQ(loser.waitForExit(), 1);
  EXPECT_NE(loser.log().find("GUID "), std::string::npos) << loser.log();
  for (const dds::ToolForce& force : client.forces()) EXPECT_EQ(force.session, answer->session);
}

TEST_F(Rivals, ServersThatAreAddressedShareADomain) {
  ASSERT_NO_FATAL_FAILURE(start({"--addressed-only", "--server-id", "1"}));
  const auto second = another({"--addressed-only", "--server-id", "2"});
  const auto posed = [&](std::uint32_t server_id) {
    dds::ToolPose pose = client_->poseAt(atDepth(-0.01));
    pose.server_id = server_id;
    client_->send(pose);
  };
  const auto answers = [&](std::uint32_t server_id) {
    const auto forces = client_->forces();
    return std::count_if(forces.begin(), forces.end(),
                         [&](const auto& force) { return force.server_id == server_id; });
  };
  for (int i = 0; i < 3000 && (answers(1) < 50 || answers(2) < 50); ++i, pause(1)) {
    posed(1);
    posed(2);
    posed(dds::kServerAny);
  }
  EXPECT_GE(answers(1), 50) << server_->log();
  EXPECT_GE(answers(2), 50) << second->log();
  const auto forces = client_->forces();
  for (const dds::ToolForce& force : forces) EXPECT_EQ(force.flags & dds::flag::kRivalServer, 0U);
  EXPECT_EQ(status().rivals, 0U);
}

TEST_F(Rivals, ForcesOfARivalAreFlaggedAndReportedAndTheServerGoesOn) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  {
    const dds::Participant participant(domain_);
    dds::Writer<dds::ToolForce> rival(participant);
    ASSERT_TRUE(rival.waitForReaders(2, std::chrono::seconds(5)));
    dds::ToolForce force{};
    force.session = 0xabc;
    force.force[0] = 8.614;
    client_->forget();
    for (int i = 0; i < 300; ++i, pause(1)) (void)rival.write(force);
    EXPECT_TRUE(client_->waitFor([](const auto& f) { return (f.flags & dds::flag::kRivalServer) != 0; }));
    const auto told = client_->waitForStatus([](const auto& s) { return s.rivals > 0; });
    ASSERT_TRUE(told.has_value());
    EXPECT_NE(std::string(told->rival).find("session 0000000000000abc"), std::string::npos) << told->rival;
  }
  EXPECT_NE(server_->log().find("another server answers the same poses: server 0, session 0000000000000abc"),
            std::string::npos)
      << server_->log();
  std::vector<dds::ToolForce> own = client_->forces();
  std::erase_if(own, [&](const auto& force) { return force.session != settled_.session; });
  ASSERT_GT(own.size(), 200U);
  for (const dds::ToolForce& force : own) EXPECT_NEAR(force.force[2], settled_.force[2], 1e-9);
}

TEST_F(RivalsAtLength, ARequestThatTwoServersTookIsNotReportedForOne) {
  ASSERT_NO_FATAL_FAILURE(start({"--listen-first", "0"}));
  client_->startSending(atDepth(-0.01));
  ASSERT_TRUE(client_->waitFor([](const auto& f) { return f.seq > 100; })) << server_->log();
  const auto second = another({"--listen-first", "0"});  // beside one that answers already
  ASSERT_TRUE(client_->waitFor([](const auto& f) { return (f.flags & dds::flag::kRivalServer) != 0; }))
      << second->log();
  // It listens 200 ms for a second one, which is too short where that has no processor for as long.
  palpate::testing::ProgramResult result;
  for (int i = 0; i < 3 && result.exit_code != 1; ++i)
    result = palpate::testing::runProgram(
        "palpate-parameters", {"--domain", std::to_string(domain_), "--friction", "0.1", "--wait", "5"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("2 servers have the id 0 and each answers for itself"), std::string::npos)
      << result.err;
}

TEST_F(RivalsAtLength, InventedServersCostNoTicks) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  const dds::Participant participant(domain_);
  dds::Writer<dds::ToolForce> rival(participant);
  ASSERT_TRUE(rival.waitForReaders(2, std::chrono::seconds(5)));
  client_->forget();
  dds::ToolForce force{};
  for (int i = 0; i < 10'000; ++i) {
    ++force.session;
    force.server_id = static_cast<std::uint32_t>(i % 7);
    (void)rival.write(force);
    if (i % 20 == 0) pause(1);
  }
  std::vector<dds::ToolForce> own = client_->forces();
  std::erase_if(own, [&](const auto& answer) { return answer.session != settled_.session; });
  ASSERT_FALSE(own.empty());
  const double seconds = 1e-9 * static_cast<double>(own.back().stamp_ns - own.front().stamp_ns);
  EXPECT_GE(static_cast<double>(own.back().seq - own.front().seq), 900.0 * seconds);
}

}  // namespace
}  // namespace palpate::server::testing
