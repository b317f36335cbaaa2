// SPDX-License-Identifier: Apache-2.0
// Live parameters as a user changes them: palpate-parameters beside a running palpate-server.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "palpate/testing/run_program.h"
#include "server_fixture.h"

namespace palpate::server::testing {
namespace {

using nlohmann::json;

class Parameters : public ServerEndToEnd {
 protected:
  // What palpate-parameters --json prints; null when it prints nothing.
  json ask(std::vector<std::string> arguments, int exit_code = 0) {
    arguments.insert(arguments.end(), {"--json", "--domain", std::to_string(domain_), "--wait", "20"});
    const auto result = palpate::testing::runProgram("palpate-parameters", arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    return json::parse(result.out, nullptr, false);
  }
};

TEST_F(Parameters, AreToldAndChangedAndSurviveARefusal) {
  ASSERT_NO_FATAL_FAILURE(start({"--device", "omni", "--friction", "0.4"}));
  json answer = ask({});
  EXPECT_EQ(answer["revision"], 0);
  EXPECT_EQ(answer["friction"], 0.4);
  EXPECT_EQ(answer["rendered_stiffness_N_per_m"], 400.0);
  const double organ = answer["model_stiffness_N_per_m"];
  EXPECT_GT(organ, 400.0);
  EXPECT_NEAR(answer["coupling_N_per_m"].get<double>(), 1.0 / (1.0 / 400.0 - 1.0 / organ), 1e-6 * organ);
  EXPECT_TRUE(answer["force_rate_limit_N_per_s"].is_null()) << "no bound";
  answer = ask({"--friction", "0.1", "--youngs-modulus", "5e4"});
  EXPECT_TRUE(answer["accepted"]);
  EXPECT_EQ(answer["friction"], 0.1);
  EXPECT_EQ(answer["youngs_modulus_Pa"], 5e4);
  EXPECT_EQ(answer["revision"], 1);
  EXPECT_EQ(answer["limits"]["youngs_modulus_Pa"], json::array({100.0, 160e3}));
  EXPECT_TRUE(answer["open"]);
  EXPECT_TRUE(answer["coupling_N_per_m"].is_null()) << "softer than the device renders";
  answer = ask({"--friction", "0.2", "--force-limit", "4"}, 1);
  EXPECT_FALSE(answer["accepted"]);
  EXPECT_EQ(answer["message"].get<std::string>().find("force_limit is 4, expected 0.01 to 3.3 N"), 0U)
      << answer["message"];
  EXPECT_EQ(answer["friction"], 0.1) << "nothing has changed";
  EXPECT_EQ(ask({"--force-limit", "nan"}, 1)["revision"], 1);
  const auto status = client_->waitForStatus([](const auto& s) { return s.parameters_revision == 1; });
  ASSERT_TRUE(status.has_value());
  EXPECT_EQ(status->friction, 0.1);
  EXPECT_EQ(status->youngs_modulus, 5e4);
  EXPECT_TRUE(std::isinf(status->coupling_stiffness));
}

TEST_F(Parameters, OfAnotherServerAreNotOurs) {
  ASSERT_NO_FATAL_FAILURE(start({"--server-id", "3"}));
  const auto result = palpate::testing::runProgram(
      "palpate-parameters", {"--friction", "0.1", "--domain", std::to_string(domain_), "--wait", "1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("no server 0 answered"), std::string::npos) << result.err;
  EXPECT_EQ(ask({"--server-id", "3"})["revision"], 0);
}

TEST_F(Parameters, OfAnotherRunOfThisServerAreNotOurs) {
  ASSERT_NO_FATAL_FAILURE(start());
  const dds::Participant participant(domain_);
  dds::Writer<dds::ParameterRequest> writer(participant);
  dds::Reader<dds::ServerParameters> answers(participant);
  ASSERT_TRUE(writer.waitForReaders(1, std::chrono::seconds(5)));
  const auto status = client_->waitForStatus([](const auto& s) { return s.session != 0; });
  ASSERT_TRUE(status.has_value());
  dds::ParameterRequest request{};
  request.fields = dds::parameter::kFriction;
  request.friction = 0.1;
  for (const std::uint64_t session : {status->session + 1, status->session}) {
    request.session = session;
    request.request_id = session;
    ASSERT_TRUE(writer.write(request));
  }
  dds::ServerParameters answer{};
  std::array<dds::ServerParameters, dds::kMaxTake> taken;
  for (int i = 0; i < 100 && answer.request_id == 0; ++i, pause(20))
    if (const std::size_t count = answers.take(taken); count > 0) answer = taken[count - 1];
  EXPECT_EQ(answer.request_id, status->session);
  EXPECT_EQ(answer.session, status->session);
  EXPECT_EQ(answer.revision, 1U) << "the first request changed nothing";
}

TEST_F(Parameters, NoClientMakesTheOrganStifferThanTheOperator) {
  ASSERT_NO_FATAL_FAILURE(start());
  EXPECT_EQ(ask({"--youngs-modulus", "1e9"}, 1)["message"].get<std::string>().find(
                "youngs_modulus is 1e+09, expected 100 to 160000 Pa"),
            0U);
}

TEST_F(Parameters, AreRefusedWhereTheyAreOff) {
  ASSERT_NO_FATAL_FAILURE(start({"--parameters", "off"}));
  EXPECT_EQ(ask({"--friction", "0.1"}, 1)["message"], "this server takes no parameters from clients");
  EXPECT_FALSE(ask({})["open"]) << "asking is answered";
}

TEST_F(Parameters, ForceScalesWithEAndNeverSteps) {
  ASSERT_NO_FATAL_FAILURE(start({"--limit", "youngs-modulus=100:1e6"}));
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  const double before = sizeOf(settled_.force);
  const double E = ask({})["model_youngs_modulus_Pa"];
  for (const double factor : {0.25, 2.0, 1.0}) {
    client_->forget();
    EXPECT_TRUE(ask({"--youngs-modulus", std::to_string(factor * E)})["accepted"]);
    pause(200);
    ASSERT_NO_FATAL_FAILURE(settle());
    EXPECT_NEAR(sizeOf(settled_.force), factor * before, 1e-6 * before);
    EXPECT_LT(steepest(client_->forces()), 0.1 * before) << "a change is gone over to, not jumped to";
  }
}

TEST_F(Parameters, OfOneToolLeaveTheOthersAndTheirForces) {
  ASSERT_NO_FATAL_FAILURE(start({"--tool", "1:device=omni,force-limit=0.2,tip-radius=0.004"}));
  json answer = ask({"--tool", "1"});
  EXPECT_EQ(answer["device"], "omni");
  EXPECT_EQ(answer["tip_radius_m"], 0.004);
  EXPECT_EQ(answer["limits"]["force_limit_N"], json::array({0.01, 0.2}));
  EXPECT_EQ(answer["tools"][0]["device"], "custom");
  ASSERT_NO_FATAL_FAILURE(press(0.002));
  const double before = sizeOf(settled_.force);
  ASSERT_GT(before, 0.5);
  EXPECT_TRUE(ask({"--tool", "1", "--force-limit", "0.1"})["accepted"]);
  EXPECT_EQ(ask({"--tool", "0"})["force_limit_N"], 3.3);
  pause(100);
  ASSERT_NO_FATAL_FAILURE(settle());
  EXPECT_NEAR(sizeOf(settled_.force), before, 1e-6);
  client_ = std::make_unique<TestClient>(domain_, 1);
  ASSERT_TRUE(client_->connect());
  ASSERT_NO_FATAL_FAILURE(press(0.002));
  EXPECT_NEAR(sizeOf(settled_.force), 0.1, 1e-6) << "tool 1's own limit";
}

// What holds for tool 0 once `there` says so, within 5 s.
template <class Ask, class There>
json eventually(Ask ask, There there) {
  json answer = ask();
  for (int i = 0; i < 50 && !there(answer["tools"][0]); ++i, pause(100)) answer = ask();
  return answer["tools"][0];
}

TEST_F(Parameters, ThatADriverAnnouncesHoldForItsToolUntilItLeaves) {
  ASSERT_NO_FATAL_FAILURE(start({"--device", "touch"}));
  ASSERT_NO_FATAL_FAILURE(press(0.002));
  const auto now = [&] { return ask({}); };
  dds::ToolAnnouncement said{};
  said.server_id = dds::kServerAny;
  said.device_force_limit = 0.05;
  TestClient stranger(domain_, 3);
  ASSERT_TRUE(stranger.connect());
  stranger.announce(said);  // for tool 0, which is not the stranger's
  dds::assignText(said.device, "omni");
  said.device_force_limit = 0.2;
  said.fields = dds::parameter::kFriction;
  said.values.friction = 0.1;
  client_->announce(said);
  json tool = eventually(now, [](const json& t) { return t["friction"] == 0.1; });
  EXPECT_EQ(tool["device"], "omni");
  EXPECT_EQ(tool["force_limit_N"], 0.2);
  EXPECT_EQ(tool["limits"]["force_limit_N"], json::array({0.01, 0.2})) << "no request goes beyond the device";
  EXPECT_EQ(tool["rendered_stiffness_N_per_m"], 300.0) << "an omni bears more, the operator gave this";
  EXPECT_EQ(ask({})["tools"][3]["force_limit_N"], 3.3);
  pause(100);
  ASSERT_NO_FATAL_FAILURE(settle());
  EXPECT_NEAR(sizeOf(settled_.force), 0.2, 1e-6);
  said.values.friction = 0.9;
  client_->announce(said);
  tool = eventually(now, [](const json& t) { return t["refusal"] != ""; });
  EXPECT_EQ(tool["refusal"].get<std::string>().find("friction is 0.9, expected 0 to 0.3"), 0U) << tool;
  EXPECT_EQ(tool["friction"], 0.1) << "nothing has changed";
  EXPECT_EQ(tool["force_limit_N"], 0.2);
  client_.reset();
  tool = eventually(now, [](const json& t) { return t["device"] == "touch"; });
  EXPECT_EQ(tool["force_limit_N"], 3.3);
  EXPECT_EQ(tool["friction"], 0.3);
  EXPECT_EQ(tool["announced"], false);
}

TEST_F(Parameters, AfterAnAnnouncementReachALateReaderWithTheirSession) {
  ASSERT_NO_FATAL_FAILURE(start({"--device", "touch"}));
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  dds::ToolAnnouncement said{};
  said.server_id = dds::kServerAny;
  said.device_force_limit = 0.5;
  client_->announce(said);
  ASSERT_TRUE(logs("tool 0: its driver's word holds"));
  pause(50);
  const dds::Participant participant(domain_);
  dds::Reader<dds::ServerParameters> late(participant);
  dds::ServerParameters answer{};
  for (int i = 0; i < 250 && late.take({&answer, 1}) == 0; ++i) pause(20);
  EXPECT_EQ(answer.tools[0].now.force_limit, 0.5);
  const auto status = client_->waitForStatus([](const auto& s) { return s.session != 0; });
  ASSERT_TRUE(status.has_value());
  EXPECT_EQ(answer.session, status->session);
}

TEST_F(Parameters, ALowerForceLimitIsReachedWithoutAStep) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.003));
  const double before = sizeOf(settled_.force);
  ASSERT_GT(before, 1.0);
  client_->forget();
  EXPECT_TRUE(ask({"--force-limit", "0.2"})["accepted"]);
  pause(200);
  ASSERT_NO_FATAL_FAILURE(settle());
  EXPECT_NEAR(sizeOf(settled_.force), 0.2, 1e-6);
  EXPECT_NE(settled_.flags & dds::flag::kForceLimited, 0U);
  EXPECT_LT(steepest(client_->forces()), 0.1 * before);
}

}  // namespace
}  // namespace palpate::server::testing
