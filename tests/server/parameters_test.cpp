// SPDX-License-Identifier: Apache-2.0
// Live parameters as a user changes them: palpate-parameters beside a running palpate-server.
#include <gtest/gtest.h>

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
  EXPECT_EQ(answer["coupling_N_per_m"], 400.0);
  EXPECT_TRUE(answer["force_rate_limit_N_per_s"].is_null()) << "no bound";
  answer = ask({"--friction", "0.1", "--youngs-modulus", "5e4"});
  EXPECT_TRUE(answer["accepted"]);
  EXPECT_EQ(answer["friction"], 0.1);
  EXPECT_EQ(answer["youngs_modulus_Pa"], 5e4);
  EXPECT_EQ(answer["revision"], 1);
  answer = ask({"--friction", "0.2", "--coupling", "701"}, 1);
  EXPECT_FALSE(answer["accepted"]);
  EXPECT_EQ(answer["message"].get<std::string>().find("coupling_stiffness is 701, expected at most 700 N/m"),
            0U)
      << answer["message"];
  EXPECT_EQ(answer["friction"], 0.1) << "nothing has changed";
  EXPECT_EQ(ask({"--force-limit", "nan"}, 1)["revision"], 1);
  const auto status = client_->waitForStatus([](const auto& s) { return s.parameters_revision == 1; });
  ASSERT_TRUE(status.has_value());
  EXPECT_EQ(status->friction, 0.1);
  EXPECT_EQ(status->youngs_modulus, 5e4);
  EXPECT_EQ(status->coupling_stiffness, 400.0);
}

TEST_F(Parameters, OfAnotherServerAreNotOurs) {
  ASSERT_NO_FATAL_FAILURE(start({"--server-id", "3"}));
  const auto result = palpate::testing::runProgram(
      "palpate-parameters", {"--friction", "0.1", "--domain", std::to_string(domain_), "--wait", "1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("no server 0 answered"), std::string::npos) << result.err;
  EXPECT_EQ(ask({"--server-id", "3"})["revision"], 0);
}

TEST_F(Parameters, ForceScalesWithEAndNeverSteps) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  const double before = sizeOf(settled_.force);
  const double E = ask({})["model_youngs_modulus_Pa"];
  for (const double factor : {0.25, 2.0, 1.0}) {
    client_->forget();
    EXPECT_TRUE(ask({"--youngs-modulus", std::to_string(factor * E)})["accepted"]);
    pause(250);
    const auto forces = client_->forces();
    EXPECT_NEAR(sizeOf(forces.back().force), factor * before, 1e-6 * before);
    EXPECT_LT(steepest(forces), 0.1 * before) << "a change is gone over to, not jumped to";
  }
}

TEST_F(Parameters, ALowerForceLimitIsReachedWithoutAStep) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.003));
  const double before = sizeOf(settled_.force);
  ASSERT_GT(before, 1.0);
  client_->forget();
  EXPECT_TRUE(ask({"--force-limit", "0.2"})["accepted"]);
  pause(250);
  const auto forces = client_->forces();
  EXPECT_NEAR(sizeOf(forces.back().force), 0.2, 1e-6);
  EXPECT_NE(forces.back().flags & dds::flag::kForceLimited, 0U);
  EXPECT_LT(steepest(forces), 0.1 * before);
}

}  // namespace
}  // namespace palpate::server::testing
