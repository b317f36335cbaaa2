// SPDX-License-Identifier: Apache-2.0
// Another organ while the server runs: palpate-parameters --model, while tools press at 1 kHz and a viewer reads.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "palpate/testing/run_program.h"
#include "server_fixture.h"
#include "tools/modelfile/write_model.h"

namespace palpate::server::testing {
namespace {

using nlohmann::json;
using palpate::testing::runProgram;

constexpr double kRate = 50.0;  // N/s: slower than the ramp of 30 ms

class Swap : public ServerEndToEnd {
 protected:
  Swap() {
    palpate::testing::writeSyntheticModel(folder_ / "stiff.h5", {.subdivisions = 2, .stiffness = 600.0});
    palpate::testing::writeSyntheticModel(folder_ / "soft.h5", {.stiffness = 150.0});
  }

  void startWithModels(std::vector<std::string> more = {}) {
    more.insert(more.end(),
                {"--models", folder_.path().string(), "--force-rate-limit", std::to_string(kRate)});
    ASSERT_NO_FATAL_FAILURE(start(std::move(more)));
  }

  // What palpate-parameters --json prints.
  palpate::testing::ProgramResult ask(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--json", "--domain", std::to_string(domain_), "--wait", "20"});
    return runProgram("palpate-parameters", arguments);
  }
  json parameters(const std::vector<std::string>& arguments, int exit_code = 0) {
    return checked(ask(arguments), exit_code);
  }
  json swapTo(const std::string& name, int exit_code = 0) {
    auto result = ask({"--model", name});
    for (int i = 0; i < 40 && result.out.find("looked at a moment ago") != std::string::npos; ++i) {
      pause(500);  // the rest after the one before
      result = ask({"--model", name});
    }
    return checked(result, exit_code);
  }
  json checked(const palpate::testing::ProgramResult& result, int exit_code) const {
    EXPECT_EQ(result.exit_code, exit_code) << result.err << server_->log();
    return json::parse(result.out, nullptr, false);
  }
  static std::string idOf(const std::filesystem::path& model) {
    return json::parse(runProgram("palpate-inspect", {model.string(), "--json"}).out)["model_id"];
  }

  palpate::testing::TemporaryFolder folder_;
};

// What holds for the answers to one tool over one exchange. @return how many were lost
std::uint64_t judged(const std::vector<dds::ToolForce>& forces) {
  EXPECT_LE(steepest(forces), kRate * 1e-3 * 1.001);
  std::set<std::uint64_t> models, sessions;
  std::uint32_t flags = 0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    models.insert(forces[i].model_hash);
    sessions.insert(forces[i].session);
    flags |= forces[i].flags;
    if (i == 0) continue;
    EXPECT_GE(forces[i].pose_seq, forces[i - 1].pose_seq);
    if (forces[i].model_hash != forces[i - 1].model_hash && forces[i].seq == forces[i - 1].seq + 1) {
      EXPECT_EQ(sizeOf(forces[i - 1].force), 0.0) << "it was taken at zero force";
    }
  }
  EXPECT_EQ(models.size(), 2U);
  EXPECT_EQ(sessions.size(), 1U) << "the server is the same";
  EXPECT_NE(flags & dds::flag::kModelChanging, 0U);
  EXPECT_EQ(flags & (dds::flag::kShuttingDown | dds::flag::kNonFiniteForce), 0U);
  return gaps(forces);
}

TEST_F(Swap, WhileToolsPressIsSmoothAndLosesNothing) {
  std::filesystem::copy_file(model_, folder_ / "first.h5");
  ASSERT_NO_FATAL_FAILURE(startWithModels());
  TestClient second(domain_, 1);
  ASSERT_TRUE(second.connect());
  second.startSending(along(target_.position, target_.normal, 0.004));
  ASSERT_NO_FATAL_FAILURE(press(0.0015));
  // Best effort may lose samples while the machine stands still; a server that skips loses them every time.
  std::uint64_t lost = 1;
  json answer;
  for (int attempt = 0; attempt < 5 && lost > 0; ++attempt) {
    if (attempt > 0) (void)swapTo("first.h5");
    pause(150);
    ASSERT_NO_FATAL_FAILURE(settle());
    const double before = sizeOf(settled_.force);
    client_->forget();
    second.forget();
    answer = swapTo("stiff.h5");
    EXPECT_TRUE(answer["accepted"]);
    EXPECT_EQ(answer["model_id"], idOf(folder_ / "stiff.h5"));
    pause(350);
    ASSERT_NO_FATAL_FAILURE(settle());
    EXPECT_GT(sizeOf(settled_.force), 1.5 * before) << "the other organ is twice as stiff";
    lost = judged(client_->forces()) + judged(second.forces());
  }
  EXPECT_EQ(lost, 0U) << server_->log();
  const auto target = TestClient(domain_, 2).findTarget();
  ASSERT_TRUE(target.has_value());
  EXPECT_EQ(target->nodes, 162U) << "late readers get the new surface";
  const auto status = client_->waitForStatus([&](const auto& s) { return answer["model_id"] == s.model_id; });
  ASSERT_TRUE(status.has_value());
  EXPECT_EQ(status->model_hash, client_->forces().back().model_hash);
  EXPECT_EQ(status->dropped, 0U);
  EXPECT_TRUE(logs("another organ: model stiff.h5: driven by displacement, 162 surface nodes"));
}

TEST_F(Swap, AViewerWithoutAScreenGoesOnWithTheNewSurface) {
  ASSERT_NO_FATAL_FAILURE(startWithModels());
  ASSERT_NO_FATAL_FAILURE(press(0.0015));
  std::string watched;
  std::thread watch([&] {
    const auto result =
        runProgram("palpate-watch", {"--seconds", "10", "--json", "--domain", std::to_string(domain_)});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("the server took another model"), std::string::npos) << result.err;
    watched = result.out;
  });
  pause(1000);
  EXPECT_TRUE(swapTo("stiff.h5")["accepted"]);
  watch.join();
  const json report = json::parse(watched);
  EXPECT_EQ(report["model_id"], idOf(folder_ / "stiff.h5"));
  EXPECT_EQ(report["surface_nodes"], 162);
  EXPECT_EQ(report["model_changes"], 1);
  EXPECT_GT(report["peak"]["size"], 1e-4) << "of the new organ";
}

TEST_F(Swap, ParametersStayButForTheOrgansOwnE) {
  ASSERT_NO_FATAL_FAILURE(startWithModels({"--device", "touch", "--friction", "0.4"}));
  const json before = parameters({"--friction", "0.1", "--youngs-modulus", "5e4", "--force-limit", "2"});
  EXPECT_TRUE(before["models"]);
  const json after = swapTo("soft.h5");
  EXPECT_EQ(after["friction"], 0.1);
  EXPECT_EQ(after["force_limit_N"], 2.0);
  EXPECT_EQ(after["youngs_modulus_Pa"], after["model_youngs_modulus_Pa"]);
  EXPECT_LT(after["model_stiffness_N_per_m"], before["model_stiffness_N_per_m"]);
  EXPECT_EQ(after["limits"]["friction"], json::array({0.0, 0.4}));
  EXPECT_TRUE(after["coupling_N_per_m"].is_null()) << "a touch renders the soft organ as it is";
  EXPECT_EQ(parameters({"--friction", "0.2"})["friction"], 0.2) << "requests are taken as before";
}

TEST_F(Swap, ARefusedOneLeavesEverythingAsItIsAndSaysWhy) {
  ASSERT_NO_FATAL_FAILURE(startWithModels({"--limit", "youngs-modulus=1e5:2e5"}));
  (void)folder_.write("broken.h5", "no model");
  std::filesystem::copy_file(folder_ / "stiff.h5", folder_ / "short.h5");
  std::filesystem::resize_file(folder_ / "short.h5", 20000);
  std::filesystem::copy_file(folder_ / "stiff.h5", folder_ / "flipped.h5");
  std::fstream flipped(folder_ / "flipped.h5", std::ios::binary | std::ios::in | std::ios::out);
  flipped.seekp(static_cast<std::streamoff>(std::filesystem::file_size(folder_ / "flipped.h5") / 2));
  flipped.write("xxxxxxxx", 8);
  flipped.close();
  std::filesystem::copy_file(folder_ / "stiff.h5", folder_ / "sparse.h5");
  std::filesystem::resize_file(folder_ / "sparse.h5", std::uint64_t{1} << 40U);
  std::string bytes = palpate::testing::contentOf(folder_ / "stiff.h5");
  const std::uint64_t tree = bytes.find("TREE");  // its level, then its first child: itself
  bytes[tree + 5] = 1;
  std::memcpy(bytes.data() + tree + 32, &tree, sizeof tree);
  (void)folder_.write("endless.h5", bytes);
  bytes = palpate::testing::contentOf(folder_ / "stiff.h5");
  const std::uint64_t all =
      ~std::uint64_t{1};  // bytes of the heap of names: HDF5 1.10.8 writes over its own memory
  std::memcpy(bytes.data() + bytes.find("HEAP") + 8, &all, sizeof all);
  (void)folder_.write("heap.h5", bytes);
  std::filesystem::create_symlink(model_, folder_ / "out.h5");
  modelfile::ModelData soft = palpate::testing::syntheticModel();
  soft.attributes.E = 2e4;
  modelfile::writeModel(folder_ / "very_soft.h5", soft);
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  const auto status = client_->waitForStatus([](const auto& s) { return s.session != 0; });
  ASSERT_TRUE(status.has_value());
  client_->forget();
  const std::vector<std::pair<std::string, std::string>> refused{
      {"broken.h5", "broken.h5: "},
      {"short.h5", "short.h5: "},
      {"flipped.h5", "flipped.h5: "},
      {"sparse.h5", "sparse.h5: its copy needs 1048576 MiB of memory, "},
      {"endless.h5", "endless.h5: the process that parses it ended by Segmentation fault"},
      {"heap.h5", "heap.h5: the process that parses it ended by "},
      {"out.h5", "model \"out.h5\" leads out of the server's folder of models"},
      {"../x.h5", "holds \"..\""},
      {"/etc/passwd", "is no path relative to the server's folder of models"},
      {"none.h5", "model \"none.h5\" is not in the server's folder of models"},
      {".", "is no regular file"},
      {"very_soft.h5", "limits: with this model youngs_modulus is 20000"}};
  for (const auto& [name, why] : refused) {
    const json answer = swapTo(name, 1);
    EXPECT_FALSE(answer["accepted"]) << name;
    EXPECT_NE(answer["message"].get<std::string>().find(why), std::string::npos) << answer["message"];
    EXPECT_EQ(answer["revision"], 0) << name;
    EXPECT_EQ(answer["model_id"], std::string(status->model_id)) << name;
  }
  const double before = sizeOf(settled_.force);
  ASSERT_NO_FATAL_FAILURE(settle());
  EXPECT_NEAR(sizeOf(settled_.force), before, 1e-6 * before);
  for (const dds::ToolForce& force : client_->forces()) {
    ASSERT_EQ(force.model_hash, status->model_hash);
    ASSERT_EQ(force.flags & dds::flag::kModelChanging, 0U);
  }
  EXPECT_EQ(gaps(client_->forces()), 0U) << "answers that are missing";
  EXPECT_TRUE(logs("model refused: broken.h5: ")) << "of many in a second one is logged";
}

TEST_F(Swap, WithoutAFolderOfModelsIsRefused) {
  ASSERT_NO_FATAL_FAILURE(start());
  const json answer = parameters({"--model", "stiff.h5"}, 1);
  EXPECT_EQ(answer["message"],
            "this server takes no models from clients: its operator named no folder of models (--models)");
  EXPECT_FALSE(answer["models"]);
}

TEST_F(Swap, ToTheModelThatAnswersAlreadyIsDoneAtOnce) {
  std::filesystem::copy_file(model_, folder_ / "same.h5");
  ASSERT_NO_FATAL_FAILURE(startWithModels());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  client_->forget();
  EXPECT_EQ(parameters({"--model", "same.h5"})["revision"], 0);
  for (const dds::ToolForce& force : client_->forces())
    ASSERT_EQ(force.flags & dds::flag::kModelChanging, 0U);
}

TEST_F(Swap, ThereAndBackManyTimesEndsInOrder) {
  ASSERT_NO_FATAL_FAILURE(startWithModels());
  ASSERT_NO_FATAL_FAILURE(press(0.0015));
  std::filesystem::copy_file(model_, folder_ / "first.h5");
  const double before = sizeOf(settled_.force);
  client_->forget();
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(swapTo("soft.h5")["accepted"]);
    EXPECT_TRUE(swapTo("first.h5")["accepted"]);
  }
  pause(250);
  ASSERT_NO_FATAL_FAILURE(settle());
  EXPECT_NEAR(sizeOf(settled_.force), before, 1e-6 * before);
  server_->signal(SIGTERM);
  EXPECT_EQ(server_->waitForExit(), 0) << server_->log();
}

TEST_F(Swap, ARecordedSessionGoesOnInAnotherFile) {
  const palpate::testing::TemporaryFolder records;
  ASSERT_NO_FATAL_FAILURE(startWithModels({"--record", (records / "session.rec").string()}));
  ASSERT_NO_FATAL_FAILURE(press(0.0015));
  (void)parameters({"--friction", "0.2"});
  EXPECT_TRUE(swapTo("soft.h5")["accepted"]);
  pause(300);
  server_->signal(SIGTERM);
  EXPECT_EQ(server_->waitForExit(), 0) << server_->log();
  EXPECT_NE(server_->log().find("the recording goes on in " + (records / "session-2.rec").string()),
            std::string::npos)
      << server_->log();
  const std::pair<const char*, std::filesystem::path> files[]{{"session.rec", model_},
                                                              {"session-2.rec", folder_ / "soft.h5"}};
  for (const auto& [name, model] : files) {
    const auto result =
        runProgram("palpate-replay", {(records / name).string(), "--model", model.string(), "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
    const json report = json::parse(result.out);
    EXPECT_TRUE(report["identical"]) << name;
    EXPECT_GT(report["ticks"], 200) << name;
    EXPECT_GT(report["largest_force_N"], 0.05) << name;
  }
}

TEST_F(Swap, GoesAloneInARequest) {
  const auto both = runProgram("palpate-parameters", {"--model", "a.h5", "--friction", "0.1"});
  EXPECT_EQ(both.exit_code, 2);
  palpate::testing::expectOneLineError(both, "--model goes alone");
  palpate::testing::expectOneLineError(runProgram("palpate-parameters", {"--model", ""}), "--model is empty");
  palpate::testing::expectOneLineError(runProgram("palpate-parameters", {"--model", std::string(256, 'x')}),
                                       "--model has 256 characters, at most 255 can be sent");
}

}  // namespace
}  // namespace palpate::server::testing
