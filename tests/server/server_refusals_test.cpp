// SPDX-License-Identifier: Apache-2.0
// What palpate-server does with what it cannot use: one line on standard error, exit code 2 for settings, 1 for files.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>

#include "palpate/testing/run_program.h"
#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"
#include "palpate/testing/timed_tests.h"
#include "tools/modelfile/write_model.h"

namespace palpate::server::testing {
namespace {

using palpate::testing::ServerProcess;

// CYCLONEDDS_URI, as long as it lives.
class DdsSettings {
 public:
  explicit DdsSettings(const std::string& settings) { setenv("CYCLONEDDS_URI", settings.c_str(), 1); }
  ~DdsSettings() { setenv("CYCLONEDDS_URI", before_.c_str(), 1); }
  DdsSettings(const DdsSettings&) = delete;
  DdsSettings& operator=(const DdsSettings&) = delete;

 private:
  const std::string before_ = getenv("CYCLONEDDS_URI");
};

class ServerRefuses : public ::testing::Test {
 protected:
  ServerRefuses() { palpate::testing::useLoopback(); }

  // The line, without the program's name.
  std::string refusal(const std::vector<std::string>& arguments, int exit_code = 2) {
    ServerProcess server(arguments);
    EXPECT_EQ(server.waitForExit(), exit_code);
    const std::string log = server.log();
    const std::string name = "palpate-server: ";
    EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 1) << log;
    EXPECT_EQ(log.find(name), 0U) << log;
    return log.size() > name.size() ? log.substr(name.size(), log.size() - name.size() - 1) : log;
  }

  const palpate::testing::TemporaryFile temporary_{"refused.h5"};
  const std::filesystem::path file_ = temporary_.path();
};

TEST(ServerProgram, SaysHowTheMachineSuitsWithoutAModel) {
  const auto text = palpate::testing::runProgram("palpate-server", {"--check-realtime", "--tick-cpu", "0"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  for (const char* part :
       {"kernel  ", "isolated CPUs  ", "interrupts  ", "real-time throttling  ", "frequency governor  ",
        "locked memory  ", "real-time priority  ", "sleep states  "})
    EXPECT_NE(text.out.find(part), std::string::npos) << text.out;
  const auto told =
      palpate::testing::runProgram("palpate-server", {"--check-realtime", "--json", "--realtime", "require"});
  const auto report = nlohmann::json::parse(told.out);
  EXPECT_EQ(report["checks"].size(), 8U);
  EXPECT_EQ(told.exit_code, report["grants_realtime"].get<bool>() ? 0 : 3);
}

TEST(ServerProgram, ReceivesIntoSmallBuffersUnlessTheEnvironmentSaysOtherwise) {
  const std::uint32_t domain = palpate::testing::exclusiveDomain();
  const palpate::testing::TemporaryFile model("buffers.h5");
  palpate::testing::writeSyntheticModel(model.path());
  for (const auto& [given, wanted] :
       {std::pair{"", "256 KiB"},
        {"<Sizing><ReceiveBufferSize>2 MiB</ReceiveBufferSize></Sizing>", "2 MiB"}}) {
    const palpate::testing::TemporaryFile trace("buffers.log");
    const DdsSettings settings(std::string(getenv("CYCLONEDDS_URI")) +
                               ",<CycloneDDS><Domain><Tracing><Category>config</Category><OutputFile>" +
                               trace.path().string() + "</OutputFile></Tracing>" + given +
                               "</Domain></CycloneDDS>");
    ServerProcess server({"--model", model.path().string(), "--domain", std::to_string(domain)});
    const auto used = [&] {
      std::ifstream file(trace.path());
      for (std::string line; std::getline(file, line);)
        if (line.find(std::string("Sizing/ReceiveBufferSize/#text: ") + wanted) != std::string::npos)
          return true;
      return false;
    };
    for (int i = 0; i < 500 && server.running() && !used(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_TRUE(used()) << server.log();
  }
}

// What a failed test asks before it runs again.
TEST(ServerProgram, ThatASignalEndsMakesAFailureCountAlways) {
  const palpate::testing::TemporaryFile model("ended.h5");
  palpate::testing::writeSyntheticModel(model.path());
  const ::testing::TestResult& result = *::testing::UnitTest::GetInstance()->current_test_info()->result();
  const std::string domain = std::to_string(palpate::testing::exclusiveDomain());
  for (const int own : {SIGKILL, SIGCONT}) {
    ServerProcess server({"--model", model.path().string(), "--domain", domain});
    server.signal(own);
    if (own != SIGKILL) {
      ASSERT_EQ(kill(server.pid(), SIGKILL), 0);
    }
    (void)server.waitForExit();
    EXPECT_EQ(result.test_property_count(), 0)
        << "not before it is gone, and not for a signal of the test's own";
  }
  ASSERT_EQ(result.test_property_count(), 1);
  EXPECT_STREQ(result.GetTestProperty(0).key(), palpate::testing::kCountsAlways);
}

TEST_F(ServerRefuses, ATruncatedModel) {
  palpate::testing::writeSyntheticModel(file_);
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
  EXPECT_NE(refusal({"--model", file_.string()}, 1).find(file_.string()), std::string::npos);
}

TEST_F(ServerRefuses, ACertificateThatIsTooLong) {
  modelfile::ModelData data = palpate::testing::syntheticModel({.subdivisions = 1, .modes = 2});
  data.attributes.certificate = std::string(65537, 'x');
  modelfile::writeModel(file_, data);
  EXPECT_EQ(refusal({"--model", file_.string()}, 1),
            file_.string() + ": attribute certificate is 65537 bytes, expected at most 65536");
}

TEST_F(ServerRefuses, AFileThatIsNoModel) {
  std::ofstream(file_) << "not a model";
  EXPECT_NE(refusal({"--model", file_.string()}, 1).find(file_.string()), std::string::npos);
}

TEST_F(ServerRefuses, AFolderOfModelsThatIsNone) {
  EXPECT_EQ(refusal({"--model", file_.string(), "--models", "/nonexistent"}),
            "the folder of models, /nonexistent, cannot be opened: No such file or directory");
  std::ofstream(file_) << "no folder";
  EXPECT_NE(refusal({"--model", file_.string(), "--models", file_.string()})
                .find("cannot be opened: Not a directory"),
            std::string::npos);
  EXPECT_EQ(refusal({"--model", file_.string(), "--models", ""}),
            "--models is empty, expected the path of a folder");
}

TEST_F(ServerRefuses, AMissingModel) {
  EXPECT_NE(refusal({"--model", "/nonexistent.h5"}, 1).find("/nonexistent.h5"), std::string::npos);
  EXPECT_EQ(refusal({"--json", "--model", "a.h5"}), "--json is for --check-realtime");
  EXPECT_EQ(refusal({}), "--model is missing: name a model file here or in --config");
}

TEST_F(ServerRefuses, OptionsOutOfRangeByName) {
  EXPECT_EQ(refusal({"--model", "m.h5", "--rate", "0"}), "--rate is 0, expected 10 to 10000 Hz");
  EXPECT_EQ(refusal({"--model", "m.h5", "--domain", "231"}), "--domain is 231, expected 0 to 230");
  EXPECT_EQ(refusal({"--model", "m.h5", "--tip-radius", "1"}).find("--tip-radius is 1"), 0U);
  EXPECT_EQ(refusal({"--model", "m.h5", "--realtime", "maybe"}),
            "--realtime is \"maybe\", expected require, prefer or off");
}

TEST_F(ServerRefuses, WhatTheDeviceDoesNotStandByName) {
  EXPECT_EQ(
      refusal({"--model", "m.h5", "--coupling", "401"}),
      "--coupling is 401, expected at most 400 N/m, what device touch renders stably (device custom has no "
      "such limit)");
  EXPECT_EQ(refusal({"--model", "m.h5", "--coupling", "inf"}).find("--coupling is inf, expected at most 400"),
            0U);
  EXPECT_EQ(refusal({"--model", "m.h5", "--coupling", "701", "--device", "omni"}).find("--coupling is 701"),
            0U);
  EXPECT_EQ(
      refusal({"--model", "m.h5", "--device", "falcon"}).find("--device is \"falcon\", expected touch, "),
      0U);
  EXPECT_EQ(refusal({"--model", "m.h5", "--friction", "3"}).find("--friction is 3, expected 0 to 2"), 0U);
  EXPECT_EQ(refusal({"--model", "m.h5", "--tools", "5"}).find("--tools is 5, expected 1 to 4"), 0U);
  EXPECT_EQ(refusal({"--model", "m.h5", "--youngs-modulus", "1"}).find("--youngs-modulus is 1, expected 100"),
            0U);
  std::ofstream(file_) << "device = \"omni\"\n[tool]\ncoupling_stiffness = 650\n";
  EXPECT_EQ(refusal({"--config", file_.string(), "--device", "touch"}).find("--coupling is 650"), 0U)
      << "what the file names stands, the command line's device does not bear it";
}

TEST_F(ServerRefuses, WhatOneToolCannotHaveByName) {
  EXPECT_EQ(refusal({"--model", "m.h5", "--tool", "1:coupling=401"})
                .find("--tool 1:coupling is 401, expected at most 400"),
            0U);
  EXPECT_EQ(refusal({"--model", "m.h5", "--tool", "2:tip-radius=0.2"})
                .find("--tool 2:tip-radius is 0.2, expected 0 to"),
            0U);
  EXPECT_EQ(refusal({"--model", "m.h5", "--tool", "2:device=falcon"})
                .find("--tool is \"falcon\", expected touch, "),
            0U);
  for (const char* word :
       {"1", "4:friction=0", "1:friction", "1:friction=x", "1:youngs-modulus=1e4", "1:frictio=1"})
    EXPECT_EQ(refusal({"--model", "m.h5", "--tool", word}).find("--tool is \"" + std::string(word) + "\""),
              0U)
        << word;
}

TEST_F(ServerRefuses, LimitsThatCannotBeByName) {
  EXPECT_EQ(refusal({"--model", "m.h5", "--coupling", "300", "--limit", "coupling=1:500"}),
            "--limit coupling is 1 to 500 N/m, expected a range within 1 to 400 N/m");
  EXPECT_EQ(refusal({"--model", "m.h5", "--limit", "friction=0:0.1"}),
            "--limit friction is 0 to 0.1, which leaves out the start's 0.3");
  for (const char* word : {"friction", "friction=1", "friction=0:x", "fric=0:1", "friction=:1"})
    EXPECT_EQ(refusal({"--model", "m.h5", "--limit", word}).find("--limit is \"" + std::string(word) + "\""),
              0U);
  EXPECT_EQ(refusal({"--model", "m.h5", "--parameters", "maybe"}),
            "--parameters is \"maybe\", expected on or off");
}

TEST_F(ServerRefuses, WhatItDoesNotKnow) {
  EXPECT_EQ(refusal({"--modle", "m.h5"}), "unknown option --modle: did you mean --model?");
  EXPECT_NE(refusal({"--rate", "fast"}).find("rate"), std::string::npos);
}

TEST(ServerExplains, ItselfAndItsVersionWithExitCodeZero) {
  for (const char* question : {"--help", "--version"}) {
    ServerProcess server({question});
    EXPECT_EQ(server.waitForExit(), 0) << question;
    EXPECT_EQ(server.log(), "") << question << ": an answer, not a complaint";
  }
}

TEST_F(ServerRefuses, AConfigurationByFileAndLine) {
  std::ofstream(file_) << "domain = 1\nspeed = 3\n";
  EXPECT_EQ(refusal({"--config", file_.string()}), file_.string() + ":2: unknown key speed");
}

TEST_F(ServerRefuses, AFlagOfTheFileCountsWhereTheCommandLineSaysNothing) {
  std::ofstream(file_) << "model = \"m.h5\"\ntick_cpu_alone = true\n";
  EXPECT_EQ(refusal({"--config", file_.string()}), "--tick-cpu-alone without --tick-cpu: which CPU is it?");
}

TEST_F(ServerRefuses, ADdsConfigurationThatCannotWork) {
  palpate::testing::writeSyntheticModel(file_);
  const DdsSettings settings(
      "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"nosuch0\"/>"
      "</Interfaces></General></Domain></CycloneDDS>");
  ServerProcess server({"--model", file_.string(), "--domain", "3"});
  EXPECT_EQ(server.waitForExit(), 1);
  EXPECT_NE(server.log().find("palpate-server: cannot create a DDS participant on domain 3"),
            std::string::npos)
      << server.log();
}

}  // namespace
}  // namespace palpate::server::testing
