// SPDX-License-Identifier: Apache-2.0
// The client programs against palpate-server itself, on a model known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "palpate/idl/types.h"
#include "palpate/testing/run_program.h"
#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"

namespace palpate::testing {
namespace {

using nlohmann::json;

struct Running {
  TemporaryFile model{"clients-e2e.h5"};
  std::string domain{std::to_string(exclusiveDomain())};
  std::unique_ptr<ServerProcess> process;

  // By default the model's own force, no coupling.
  explicit Running(const std::vector<std::string>& options = {"--device", "custom", "--friction", "inf"}) {
    writeSyntheticModel(model.path());
    std::vector<std::string> arguments{"--model", model.path().string(), "--domain", domain};
    arguments.insert(arguments.end(), options.begin(), options.end());
    process = std::make_unique<ServerProcess>(arguments);
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

TEST(RealServer, ASimulatedDeviceComesToRestOnTheOrgan) {
  const Running server({"--device", "touch"});
  const json report = server.run("palpate-device", {"--preset", "touch", "--hand", "0.1,2,200", "--motion",
                                                    "press", "--seconds", "2.5"});
  ASSERT_FALSE(report.is_null());
  EXPECT_TRUE(report["stable"]);
  EXPECT_FALSE(report["settle_s"].is_null());
  EXPECT_GT(report["penetration_m"].get<double>(), 5e-4);
  EXPECT_LT(report["penetration_m"].get<double>(), 0.003) << "the organ holds against the hand";
  EXPECT_GT(report["max_force_N"].get<double>(), 0.1);
  EXPECT_LE(report["max_force_N"].get<double>(), 3.3 + 1e-9);
  EXPECT_EQ(report["server_device"], "touch");
  EXPECT_NE(report["flags"].get<unsigned>() & dds::flag::kInContact, 0U);
  EXPECT_EQ(report["tip_m"].size(), 2501U);
}

TEST(RealServer, ADriverFromTheTemplateFeelsTheOrgan) {
  const Running server;
  const auto result = runProgram("palpate-driver-template", {"--domain", server.domain, "--origin", "0", "0",
                                                             "0.058", "--seconds", "3"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  double largest = 0.0;
  ASSERT_EQ(std::sscanf(result.out.c_str(), "largest force %lf N", &largest), 1) << result.out;
  EXPECT_GT(largest, 0.3) << "its fake device goes 5 mm below the top of the organ";
  EXPECT_LE(largest, 3.3 + 1e-4);
}

TEST(RealServer, AProgramFromTheIdlAloneWithDefaultQosFeelsTheOrgan) {
  const Running server;
  const auto result = runProgram("palpate-example-touch", {server.domain});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  double largest = 0.0;
  int answers = 0;
  ASSERT_EQ(std::sscanf(result.out.c_str(), "largest force %lf N, %d answers", &largest, &answers), 2)
      << result.out;
  EXPECT_GT(largest, 0.3) << "it presses 3 mm deep";
  EXPECT_LE(largest, 3.3 + 1e-4);
  EXPECT_GT(answers, 500);
}

TEST(RealServer, LatencyAndWatchReportTheSameRun) {
  const Running server;
  json watched;
  std::thread watch([&] { watched = server.run("palpate-watch", {"--seconds", "4"}); });
  const json report = server.run("palpate-latency", {"--seconds", "2", "--fields"});
  watch.join();
  ASSERT_FALSE(report.is_null());
  ASSERT_FALSE(watched.is_null());
  EXPECT_GT(report["pose_to_force_us"]["count"].get<int>(), 500);
  EXPECT_GT(report["pose_to_field_us"]["count"].get<int>(), 500);
  EXPECT_GT(report["pose_to_field_us"]["p50"].get<double>(), report["tick_us"]["p50"].get<double>());
  EXPECT_GT(report["tick_us"]["p50"].get<double>(), 0.0);
  EXPECT_LE(report["lost"].get<double>(), 0.01 * report["received"].get<double>());
  EXPECT_GT(watched["received"].get<int>(), 500);
  EXPECT_EQ(watched["refused"], 0);
  EXPECT_EQ(watched["model_id"], report["model_id"]);
  EXPECT_GT(watched["peak"]["size"].get<double>(), 1e-5);
}

}  // namespace
}  // namespace palpate::testing
