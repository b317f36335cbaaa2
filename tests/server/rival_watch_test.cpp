// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/rival_watch.h"

#include <gtest/gtest.h>

#include <future>
#include <optional>
#include <thread>

#include "palpate/idl/writer.h"
#include "palpate/testing/test_domain.h"

namespace palpate::server {
namespace {

Facts factsOfServer(std::uint32_t server_id, std::uint64_t session) {
  Facts facts;
  facts.server_id = server_id;
  facts.session = session;
  facts.host = "bench";
  facts.pid = 7;
  return facts;
}

// A server that starts: takes its place on the domain, or says why not.
struct Starter {
  explicit Starter(const Facts& its_facts) : facts(its_facts) {}

  std::string start(double seconds) {
    try {
      watch.emplace(participant, facts, status, seconds);
      status.publish({}, dds::server_state::kRunning);
      return "";
    } catch (const RivalError& error) {
      return error.what();
    }
  }

  Facts facts;
  dds::Participant participant{palpate::testing::exclusiveDomain()};
  StatusPublisher status{participant, facts};
  std::optional<RivalWatch> watch;
};

TEST(RivalWatch, OfTwoThatStartAtOnceTheLowerGuidGoesOn) {
  Starter one(factsOfServer(0, 1)), two(factsOfServer(0, 2));
  auto other = std::async(std::launch::async, [&] { return two.start(0.4); });
  const std::string first = one.start(0.4), second = other.get();
  const bool one_is_lower = one.participant.guid() < two.participant.guid();
  const std::string& refusal = one_is_lower ? second : first;
  EXPECT_EQ(one_is_lower ? first : second, "");
  EXPECT_NE(refusal.find("on bench, pid 7"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("GUID " + (one_is_lower ? one : two).participant.guid()), std::string::npos)
      << refusal;
}

TEST(RivalWatch, ForcesAloneKeepAServerFromBeginning) {
  const dds::Participant somebody(palpate::testing::exclusiveDomain());
  dds::Writer<dds::ToolForce> forces(somebody);
  const auto refusalBeside = [&](std::uint32_t server_id, bool answers_any) {
    Facts facts = factsOfServer(0, 1);
    facts.answers_any = answers_any;
    Starter starter(facts);
    auto refusal = std::async(std::launch::async, [&] { return starter.start(0.2); });
    dds::ToolForce force{};
    force.server_id = server_id;
    force.session = 9;
    while (refusal.wait_for(std::chrono::milliseconds(2)) != std::future_status::ready)
      (void)forces.write(force);
    return refusal.get();
  };
  EXPECT_NE(
      refusalBeside(0, true).find("server 0, session 0000000000000009, which sends forces but no status"),
      std::string::npos);
  EXPECT_NE(refusalBeside(5, true), "") << "nothing says that it leaves poses for any server alone";
  EXPECT_EQ(refusalBeside(5, false), "") << "this one answers only poses that name it";
}

TEST(RivalWatch, WhoseForcesItHearsIsWaitedFor) {
  const dds::Participant somebody(palpate::testing::exclusiveDomain());
  dds::Writer<dds::ToolForce> forces(somebody);
  dds::Writer<dds::ServerStatus> statuses(somebody);
  Starter starter(factsOfServer(0, 1));
  auto refusal = std::async(std::launch::async, [&] { return starter.start(0.1); });
  dds::ToolForce force{};
  force.session = 9;
  dds::ServerStatus status{};
  status.session = 9;
  status.answers_any = true;
  status.state = dds::server_state::kRunning;
  status.pid = 77;
  for (int i = 0; refusal.wait_for(std::chrono::milliseconds(2)) != std::future_status::ready; ++i) {
    (void)forces.write(force);
    if (i == 200) (void)statuses.write(status);  // after the listening
  }
  const std::string text = refusal.get();
  EXPECT_NE(text.find("pid 77"), std::string::npos) << text;
}

TEST(RivalWatch, AServerThatIsOnlyAddressedDisturbsNobody) {
  Facts addressed = factsOfServer(1, 1);
  addressed.answers_any = false;
  Starter first(addressed), second(factsOfServer(0, 2)), third(factsOfServer(1, 3));
  EXPECT_EQ(first.start(0.0), "");
  EXPECT_EQ(second.start(0.2), "");
  EXPECT_NE(third.start(0.2), "") << "it has the id of the first";
}

}  // namespace
}  // namespace palpate::server
