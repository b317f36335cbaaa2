// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/surface_publisher.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <ctime>
#include <memory>
#include <thread>

#include "palpate/idl/reader.h"
#include "palpate/rt/clock.h"
#include "palpate/testing/files.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"

namespace palpate::server {
namespace {

constexpr double kSecond = 1e9;  // ns

// Processor time of a thread of this process, ns.
double processorTime(pthread_t thread) {
  clockid_t clock{};
  timespec time{};
  EXPECT_EQ(pthread_getcpuclockid(thread, &clock), 0);
  EXPECT_EQ(clock_gettime(clock, &time), 0);
  return kSecond * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

// Always another surface, before a field is evaluated.
void handOver(Channels& channels, Engine& engine, double seconds) {
  const std::int64_t end = rt::monotonicNow() + std::int64_t(kSecond * seconds);
  for (std::uint64_t seq = 1; rt::monotonicNow() < end; ++seq) {
    SurfaceSample& sample = channels.surface.back();
    sample = {};
    sample.seq = seq;
    sample.engine = &engine;
    sample.state.sources.add({{0, {1.0, 0.0, 0.0}}, {0.0, 0.0, -1e-6 * double(seq % 1000)}, 1.0});
    const bool waits_already = channels.surface.publish();
    if (!waits_already) channels.surface_ready.post();
    std::this_thread::yield();
  }
}

TEST(SurfacePublisher, HasAtMostHalfOfAProcessorHoweverOftenASurfaceComes) {
  const palpate::testing::TemporaryFolder folder;
  palpate::testing::writeSyntheticModel(folder / "organ.h5", {.subdivisions = 3, .modes = 100});
  auto model = std::shared_ptr<const MetaModel>(new const MetaModel(MetaModel::load(folder / "organ.h5")));
  const auto channels = std::make_unique<Channels>();
  const Facts facts = factsOf(*model, ServerConfig{});
  Engine engine(std::move(model), facts.step);
  const dds::Participant participant(palpate::testing::exclusiveDomain());
  const dds::Reader<dds::SurfaceDisplacement> viewer(participant);
  SurfacePublisher surface_out(participant, *channels, facts);
  std::thread publishing([&] { surface_out.run(); });

  const std::int64_t began = rt::monotonicNow();
  const double used_before = processorTime(pthread_self());
  handOver(*channels, engine, 1.0);
  const double used = processorTime(publishing.native_handle());
  const double share = used / static_cast<double>(rt::monotonicNow() - began);
  const double used_here = processorTime(pthread_self()) - used_before;
  channels->stopping.store(true, std::memory_order_release);
  channels->surface_ready.post();
  publishing.join();
  EXPECT_GT(used, 0.05 * used_here)
      << "it has work all the time, as this thread has; both get less where others run";
  EXPECT_LT(share, 0.6);
  EXPECT_GT(viewer.takeLoaned().size(), 0U);
}

}  // namespace
}  // namespace palpate::server
