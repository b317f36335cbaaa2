// SPDX-License-Identifier: Apache-2.0
// A session over DDS, recorded by palpate-server and replayed by palpate-replay.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "palpate/testing/run_program.h"
#include "server_fixture.h"
#include "tools/modelfile/write_model.h"

namespace palpate::server::testing {
namespace {

using nlohmann::json;

class RecordedSession : public ServerEndToEnd {
 protected:
  // Contact, a slide, a second tool, a change of friction, a stream that stops, and the end.
  void record() {
    ASSERT_NO_FATAL_FAILURE(start({"--device", "touch", "--friction", "0.2", "--tool",
                                   "2:tip-radius=0.007,coupling=200", "--record", file_.path().string()}));
    ASSERT_NO_FATAL_FAILURE(press(0.002));
    TestClient second(domain_, 2);
    ASSERT_TRUE(second.connect());
    second.startSending(along(target_.position, target_.normal, 0.004));
    const std::string domain = std::to_string(domain_);
    const auto changed = palpate::testing::runProgram(
        "palpate-parameters", {"--friction", "0.1", "--youngs-modulus", "9e4", "--domain", domain});
    EXPECT_EQ(changed.exit_code, 0) << changed.err;
    const auto of_one = palpate::testing::runProgram(
        "palpate-parameters", {"--tool", "2", "--friction", "0.05", "--domain", domain});
    EXPECT_EQ(of_one.exit_code, 0) << of_one.err;
    Point aside = atDepth(0.002);
    aside[0] += 0.004;
    client_->moveTo(aside, 200);
    second.stopSending();
    pause(100);
    server_->signal(SIGTERM);
    EXPECT_EQ(server_->waitForExit(), 0) << server_->log();
    EXPECT_NE(server_->log().find(", 0 lost"), std::string::npos) << server_->log();
  }

  palpate::testing::ProgramResult replay(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{file_.path().string(), "--model", model_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return palpate::testing::runProgram("palpate-replay", arguments);
  }

  palpate::testing::TemporaryFile file_{"session.rec"};
};

TEST_F(RecordedSession, IsReplayedBitForBitAndDamageIsFound) {
  ASSERT_NO_FATAL_FAILURE(record());
  // The same bits.
  const auto result = replay({"--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  const json report = json::parse(result.out);
  EXPECT_TRUE(report["identical"]);
  EXPECT_GT(report["ticks"], 500);
  EXPECT_GT(report["largest_force_N"], 0.1);
  EXPECT_TRUE(report["first_difference"].is_null());
  // Another model.
  modelfile::ModelData another = palpate::testing::syntheticModel();
  another.contact_force[0] += 1e-3;
  modelfile::writeModel(model_, another);
  const auto other = replay();
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("recorded with model"), std::string::npos) << other.err;
  palpate::testing::writeSyntheticModel(model_);
  // A flipped bit.
  const auto middle = static_cast<std::streamoff>(std::filesystem::file_size(file_.path()) / 2);
  std::fstream stream(file_.path(), std::ios::binary | std::ios::in | std::ios::out);
  stream.seekg(middle);
  const int byte = stream.get();
  stream.seekp(middle);
  stream.put(static_cast<char>(byte ^ 4));
  stream.close();
  const auto flipped = replay();
  EXPECT_EQ(flipped.exit_code, 1);
  EXPECT_NE(flipped.err.find("damaged, the checksum is another"), std::string::npos) << flipped.err;
  // A truncated file.
  std::filesystem::resize_file(file_.path(), static_cast<std::uintmax_t>(middle) / 2);
  const auto truncated = replay();
  EXPECT_EQ(truncated.exit_code, 1);
  EXPECT_NE(truncated.err.find("truncated"), std::string::npos) << truncated.err;
}

TEST_F(RecordedSession, OfAServerThatWasKilledIsReplayedAsFarAsItGoes) {
  ASSERT_NO_FATAL_FAILURE(start({"--record", file_.path().string()}));
  ASSERT_NO_FATAL_FAILURE(press(0.002));
  pause(2500);
  server_->signal(SIGKILL);
  EXPECT_EQ(server_->waitForExit(), 128 + SIGKILL);
  EXPECT_NE(replay().err.find("truncated"), std::string::npos);
  const auto partial = replay({"--partial", "--json"});
  ASSERT_EQ(partial.exit_code, 0) << partial.err << partial.out;
  const json report = json::parse(partial.out);
  EXPECT_TRUE(report["truncated"]);
  EXPECT_GT(report["ticks"], 500);
  // As a table, without a model.
  const palpate::testing::TemporaryFile table("session.csv");
  const auto exported = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), file_.path().string());
    return palpate::testing::runProgram("palpate-replay", arguments);
  };
  EXPECT_EQ(exported({"--export", "csv", "-o", table.path().string()}).exit_code, 1) << "it has no end";
  EXPECT_FALSE(std::filesystem::exists(table.path()));
  const auto rows = exported({"--export", "csv", "-o", table.path().string(), "--partial", "--json"});
  ASSERT_EQ(rows.exit_code, 0) << rows.err;
  const std::string text = palpate::testing::contentOf(table.path());
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), json::parse(rows.out)["rows"].get<long>() + 1);
  EXPECT_EQ(json::parse(rows.out)["ticks"], report["ticks"]);
  EXPECT_EQ(exported({"--export", "csv"}).err,
            "palpate-replay: --export and -o belong together: --export csv -o FILE\n");
  EXPECT_EQ(exported({"--export", "csv", "-o", file_.path().string()}).exit_code, 2) << "onto itself";
  EXPECT_EQ(exported({}).exit_code, 2) << "no model";
}

TEST_F(RecordedSession, NeedsAFileThatCanBeWritten) {
  ServerProcess server(
      {"--model", model_.string(), "--domain", std::to_string(domain_), "--record", "/nonexistent/x"});
  EXPECT_EQ(server.waitForExit(), 2);
  EXPECT_EQ(server.log(),
            "palpate-server: --record: cannot write /nonexistent/x: No such file or directory\n");
}

}  // namespace
}  // namespace palpate::server::testing
