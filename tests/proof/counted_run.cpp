// SPDX-License-Identifier: Apache-2.0
#include "counted_run.h"

#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>
#include <thread>

#include "palpate/testing/run_program.h"
#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"

namespace palpate::proof {
namespace {

using palpate::testing::ServerProcess;

constexpr double kTipRadius = 0.005;  // m, the server's default
constexpr double kWarmUp = 1.5;       // s until both tools press

void wait(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

// Memory that this process and the server map.
class SharedCounts {
 public:
  SharedCounts() : descriptor_(memfd_create("palpate-tick-counts", 0)) {  // inherited by the server
    if (descriptor_ < 0 || ftruncate(descriptor_, sizeof(TickCounts)) != 0)
      throw std::runtime_error("memory to count in cannot be had");
    void* const memory =
        mmap(nullptr, sizeof(TickCounts), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
    if (memory == MAP_FAILED) throw std::runtime_error("memory to count in cannot be mapped");
    counts_ = new (memory) TickCounts;
  }
  ~SharedCounts() {
    munmap(counts_, sizeof(TickCounts));
    close(descriptor_);
  }
  SharedCounts(const SharedCounts&) = delete;
  SharedCounts& operator=(const SharedCounts&) = delete;
  TickCounts* operator->() const noexcept { return counts_; }
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
  int descriptor_;
  TickCounts* counts_{nullptr};
};

// The environment that the server is born with, taken back at the end.
class Preload {
 public:
  Preload(int descriptor, const std::string& mistake) {
    const std::string folder = PALPATE_PROOF_DIR;
    const std::string counter = folder + "/libpalpate_tick_counter.so";
    const std::string libraries = mistake.empty() ? counter : folder + "/libpalpate_wrong_tick.so:" + counter;
    setenv("LD_PRELOAD", libraries.c_str(), 1);
    setenv(kCountsVariable, std::to_string(descriptor).c_str(), 1);
    setenv(kMistakeVariable, mistake.c_str(), 1);
  }
  ~Preload() {
    for (const char* const name : {"LD_PRELOAD", kCountsVariable, kMistakeVariable}) unsetenv(name);
  }
  Preload(const Preload&) = delete;
  Preload& operator=(const Preload&) = delete;
};

std::unique_ptr<ServerProcess> startServer(const std::string& model, std::uint32_t domain,
                                           const SharedCounts& counts, const std::string& mistake,
                                           const std::filesystem::path& models) {
  const Preload preload(counts.descriptor(), mistake);
  return std::make_unique<ServerProcess>(
      std::vector<std::string>{"--model", model, "--models", models.string(), "--domain",
                               std::to_string(domain), "--friction", "0.1"});
}

// Asks for another organ; the seconds that are left of the time go by.
void swapWithin(double seconds, std::uint32_t domain) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  wait(0.2 * seconds);
  const auto asked = palpate::testing::runProgram("palpate-parameters",
                                                  {"--model", "next.h5", "--domain", std::to_string(domain)});
  if (asked.exit_code != 0) throw std::runtime_error("no other organ could be had: " + asked.err);
  std::this_thread::sleep_until(end);
}

// Until the tick thread has said that it is done.
bool stopCounting(const SharedCounts& counts) {
  counts->command.store(TickCounts::kStop, std::memory_order_relaxed);
  for (int i = 0; i < 500; ++i, wait(0.01))
    if (counts->state.load(std::memory_order_acquire) == TickCounts::kDone) return true;  // SYNC DONE
  return false;
}

}  // namespace

CountedOptions optionsFromEnvironment() {
  CountedOptions options;
  if (const char* const seconds = std::getenv("PALPATE_COUNTED_SECONDS")) {
    options.seconds = std::strtod(seconds, nullptr);
    if (!(options.seconds >= 0.5 && options.seconds <= 86400.0))
      throw std::runtime_error(std::string("PALPATE_COUNTED_SECONDS is ") + seconds +
                               ", expected 0.5 to 86400 s");
  }
  if (const char* const model = std::getenv("PALPATE_COUNTED_MODEL")) options.model = model;
  return options;
}

CountedRun countTicks(const CountedOptions& options) {
  const std::uint32_t domain = palpate::testing::exclusiveDomain();
  const palpate::testing::TemporaryFile round("counted.h5");
  const std::string path = options.model.empty() ? round.path().string() : options.model;
  if (options.model.empty()) palpate::testing::writeSyntheticModel(round.path(), {.modes = 24});
  const palpate::testing::TemporaryFolder models;
  if (options.swaps)
    palpate::testing::writeSyntheticModel(models / "next.h5", {.modes = 12, .stiffness = 400.0});
  const MetaModel model = MetaModel::load(path);
  const SharedCounts counts;
  const auto server = startServer(path, domain, counts, options.mistake, models.path());
  CountedRun run;
  {
    TwoTools tools(model, domain, kTipRadius);
    tools.start();
    wait(kWarmUp);
    (void)tools.take();
    const std::uint64_t fields_before = tools.newestField();
    counts->command.store(TickCounts::kCount, std::memory_order_relaxed);
    if (options.swaps)
      swapWithin(options.seconds, domain);
    else
      wait(options.seconds);
    const bool counted = stopCounting(counts);
    run.tools = tools.take();
    run.fields = static_cast<std::int64_t>(tools.newestField() - fields_before);
    auto status = tools.status();
    for (int i = 0; i < 5 && options.swaps && status && status->model_id == model.id(); ++i)
      status = tools.status();
    run.swapped = status && status->model_id != model.id();
    if (!counted || !status)
      throw std::runtime_error("no tick was counted; the server said:\n" + server->log());
    run.memory_locked = status->memory_locked;
    run.realtime = status->realtime;
  }
  server->signal(SIGTERM);
  (void)server->waitForExit(std::chrono::seconds(20));
  run.model = options.model.empty() ? "the tests' round organ" : options.model;
  run.seconds = options.seconds;
  run.sleeps = counts->sleeps;
  run.calls = counts->calls;
  run.posts = counts->posts;
  run.other_posts = counts->other_posts;
  run.usage = counts->usage;
  run.log = server->log();
  return run;
}

}  // namespace palpate::proof
