// SPDX-License-Identifier: Apache-2.0
// Engines are exchanged while the threads of a server look at them. What the sanitizers see: nobody reads what is being made, or
// was freed.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "palpate/idl/reader.h"
#include "palpate/rt/clock.h"
#include "palpate/server/force_publisher.h"
#include "palpate/server/model_exchange.h"
#include "palpate/server/pose_subscriber.h"
#include "palpate/server/surface_publisher.h"
#include "palpate/server/tick.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"

namespace palpate::server {
namespace {

constexpr int kExchanges = 8;
constexpr std::int64_t kPeriod = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;

std::shared_ptr<const MetaModel> loaded(const std::filesystem::path& path) {
  return std::shared_ptr<const MetaModel>(new const MetaModel(MetaModel::load(path)));
}

// The threads of a server but for DDS's: tick, force-out, surface-out. The test is the events thread.
class Threads {
 public:
  Threads(Channels& channels, Engine& first, ForcePublisher& forces, SurfacePublisher& surfaces)
      : channels_(channels),
        tick_(first, channels, {kPeriod}),
        force_out_([&forces] { forces.run(); }),
        surface_out_([&surfaces] { surfaces.run(); }),
        ticking_([this] { run(); }) {}
  ~Threads() {
    ending_ = true;
    ticking_.join();
    channels_.stopping.store(true, std::memory_order_release);
    channels_.force_ready.post();
    channels_.surface_ready.post();
    force_out_.join();
    surface_out_.join();
  }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  // A tool that presses the top of the organ, deeper and less deep.
  void run() {
    rt::Cycle cycle;
    dds::ToolPose pose{};
    pose.orientation[3] = 1.0;
    for (; !ending_; ++cycle.index) {
      cycle.deadline_ns = cycle.woke_ns = rt::monotonicNow();
      pose.seq = cycle.index + 1;
      pose.position[2] = 0.0535 + 1e-6 * static_cast<double>(cycle.index % 1000);
      intake_.accept(pose, 1, cycle.woke_ns);
      (void)tick_.run(cycle);
      std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
  }

  Channels& channels_;
  PoseIntake intake_{channels_, StepConfig{}};
  Tick tick_;
  std::atomic<bool> ending_{false};
  std::thread force_out_;
  std::thread surface_out_;
  std::thread ticking_;  // last: it uses the rest
};

TEST(SwapUnderThreads, NobodyLooksAtAnEngineThatWasFreed) {
  const palpate::testing::TemporaryFolder folder;
  palpate::testing::writeSyntheticModel(folder / "a.h5", {.subdivisions = 1, .modes = 2});
  palpate::testing::writeSyntheticModel(folder / "b.h5", {.subdivisions = 2, .modes = 2, .stiffness = 600.0});
  const auto channels = std::make_unique<Channels>();
  std::shared_ptr<const MetaModel> model = loaded(folder / "a.h5");
  ServerConfig config;
  settleTools(config);
  Facts facts = factsOf(*model, config);
  ParameterBook book(facts);
  const dds::Participant participant(palpate::testing::exclusiveDomain());
  const dds::Reader<dds::SurfaceDisplacement> viewer(participant);
  RestSurface surface(participant, facts, std::make_unique<const OrganShape>(*model));
  ForcePublisher force_out(participant, *channels, facts);
  SurfacePublisher surface_out(participant, *channels, facts);
  auto first = std::make_unique<Engine>(std::move(model), facts.step);
  Engine& begins = *first;
  ModelExchange exchange(*channels, {facts, book, surface, nullptr}, std::move(first),
                         std::make_unique<ModelLoader>(folder.path()));
  const Threads threads(*channels, begins, force_out, surface_out);
  std::int64_t now_ns = kSecond;
  for (int i = 1; i <= kExchanges; ++i) {
    now_ns += 2 * kSecond;
    const std::string name = i % 2 == 0 ? "a.h5" : "b.h5";
    std::optional<ExchangeOutcome> outcome;
    for (int tries = 0; tries < 10'000 && !outcome; ++tries) {
      const auto id = static_cast<std::uint64_t>(i);
      if (!exchange.pending(id)) (void)exchange.ask(name, id, now_ns);  // the one before is being freed
      outcome = exchange.poll(now_ns);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ASSERT_TRUE(outcome.has_value()) << i;
    EXPECT_EQ(outcome->refusal, "");
    EXPECT_EQ(channels->engine_in_use, static_cast<std::uint64_t>(i));
  }
}

}  // namespace
}  // namespace palpate::server
