// SPDX-License-Identifier: Apache-2.0
// The client programs against palpate-server itself, on a model known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "../server/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "run_program.h"
#include "test_domain.h"

namespace palpate::testing {
namespace {

using nlohmann::json;

struct Running {
  TemporaryFile model{"clients-e2e.h5"};
  std::string domain{std::to_string(exclusiveDomain())};
  std::unique_ptr<server::testing::ServerProcess> process;

  Running() {
    writeSyntheticModel(model.path());
    process = std::make_unique<server::testing::ServerProcess>(
        std::vector<std::string>{"--model", model.path().string(), "--domain", domain, "--device", "custom",
                                 "--friction", "inf"});  // the model's own force, no coupling
  }
  [[nodiscard]] json run(const std::string& program, std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--json", "--wait", "30", "--domain", domain});
    const auto result = runProgram(program, arguments);
    EXPECT_EQ(result.exit_code, 0) << program << ": " << result.err;
    return result.exit_code == 0 ? json::parse(result.out) : json();
  }
};

TEST(RealServer, PressIsPushedBackAlongTheNormal) {
  const Running server;
  const json report = server.run("palpate-tool", {"--script", "press", "--depth", "0.002", "--seconds", "2"});
  ASSERT_FALSE(report.is_null());
  // Normal stiffness 450 N/m, 2 mm deep, and a little for the higher terms; the model's fading nonlinearity
  // is 10 %.
  EXPECT_NEAR(report["summary"]["peak_force_N"].get<double>(), 0.9, 0.1);
  const auto& force = report["summary"]["peak_force_vector_N"];
  EXPECT_GT(force[2].get<double>(), 0.8);
  EXPECT_LT(std::hypot(force[0].get<double>(), force[1].get<double>()), 0.05);
  EXPECT_GT(report["summary"]["contact_s"].get<double>(), 0.5);
  EXPECT_FALSE(report["summary"]["server_left"].get<bool>());
}

TEST(RealServer, LatencyAndWatchReportTheSameRun) {
  const Running server;
  json watched;
  std::thread watch([&] { watched = server.run("palpate-watch", {"--seconds", "4"}); });
  const json report = server.run("palpate-latency", {"--seconds", "2"});
  watch.join();
  ASSERT_FALSE(report.is_null());
  ASSERT_FALSE(watched.is_null());
  EXPECT_GT(report["pose_to_force_us"]["count"].get<int>(), 500);
  EXPECT_GT(report["tick_us"]["p50"].get<double>(), 0.0);
  EXPECT_LE(report["lost"].get<double>(), 0.01 * report["received"].get<double>());
  EXPECT_GE(report["overruns"].get<int>(), 0);
  EXPECT_GT(watched["received"].get<int>(), 500);
  EXPECT_EQ(watched["refused"], 0);
  EXPECT_EQ(watched["model_id"], report["model_id"]);
  EXPECT_GT(watched["peak"]["size"].get<double>(), 1e-5);
}

}  // namespace
}  // namespace palpate::testing
