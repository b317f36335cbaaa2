// SPDX-License-Identifier: Apache-2.0
#include <malloc.h>
#include <spdlog/cfg/env.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include "command_line.h"
#include "log_sink.h"
#include "palpate/rt/memory.h"
#include "palpate/rt/spin_guard.h"
#include "palpate/server/machine_check.h"
#include "palpate/server/model_loader.h"
#include "palpate/server/server.h"
#include "palpate/server/startup.h"
#include "palpate/server/urgent_mappings.h"
#include "tools/program/certificate_line.h"
#include "tools/program/exit_code.h"
#include "tools/program/json.h"
#include "tools/program/run.h"

namespace palpate::server {
namespace {

// What ends the server. Blocked in every thread, so that only waitForSignal() ever sees one.
sigset_t stopSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) sigaddset(&signals, signal);
  return signals;
}

// DDS's threads take most of their memory at the start, and lose less of it later (docs/decisions/memory_locking.md): a MiB for each
// one's heap, and smaller receive buffers, unless the environment says otherwise.
void steadyMemoryOfDds() {
  std::string settings =
      "<CycloneDDS><Domain><Sizing>"
      "<ReceiveBufferSize>256 KiB</ReceiveBufferSize>"
      "</Sizing></Domain></CycloneDDS>";
  if (const char* const given = std::getenv("CYCLONEDDS_URI"); given != nullptr && *given != 0)
    settings += std::string(",") + given;
  setenv("CYCLONEDDS_URI", settings.c_str(), 1);
  constexpr int kHeap = 1024 * 1024;
  mallopt(M_TOP_PAD, kHeap);
}

void prepareProcess() {
  const sigset_t signals = stopSignals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  rt::shortenThreadStacks();
  steadyMemoryOfDds();
  std::signal(SIGPIPE, SIG_IGN);  // the reader of our log may close its end; the server goes on
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("palpate-server", std::make_shared<LogSink>()));
  spdlog::cfg::load_env_levels();  // SPDLOG_LEVEL=debug
}

// A real-time thread has computed for kLongestComputation without a sleep. A flood keeps a receive thread busy; many readers, or a
// machine with other work, the one that sends fields: forces go on without their priority. @return whether it is another one
bool judgeSpinning() {
  bool forces = false;
  for (const rt::ThreadFacts& thread : rt::spinningThreads(std::chrono::milliseconds(50))) {
    const int wanted = wantedPriority(thread.name);
    if (wanted == 0 && thread.fifo_priority == kMappingPriority)
      continue;  // an ordinary one that maps memory
    const bool lower = wanted == kReceivePriority || wanted == kSurfacePriority;
    spdlog::critical(
        "thread {} computes at real-time priority {} without a sleep for {} ms: {}", thread.name,
        thread.fifo_priority, kLongestComputation.count(),
        lower ? "it goes on as an ordinary thread" : "the server ends, so that the machine stays usable");
    if (const int error = lower ? rt::lowerThread(thread) : 0; error != 0)
      spdlog::critical("thread {} keeps its priority: {}", thread.name, std::strerror(error));
    forces = forces || !lower;
  }
  (void)rt::limitRealtimeWithoutSleep(kLongestComputation, kLastComputation);  // the kernel has raised it
  return forces;
}

// @return the signal; SIGXCPU when a thread spins that forces need
int waitForSignal() {
  const sigset_t signals = stopSignals();
  for (;;) {
    int signal = 0;
    if (sigwait(&signals, &signal) != 0) continue;
    if (signal != SIGXCPU || judgeSpinning()) return signal;
  }
}

program::Json jsonOf(const std::vector<MachineCheck>& checks) {
  program::Json list = program::Json::array();
  for (const MachineCheck& check : checks)
    list.push_back({{"key", check.key},
                    {"state", wordOf(check.suits)},
                    {"found", check.found},
                    {"remedy", check.remedy}});
  return {{"checks", list}, {"grants_realtime", grantsRealtime(checks)}};
}

// A verdict only where one was asked for.
int tellMachine(const ServerConfig& config) {
  const std::vector<MachineCheck> checks = checkMachine("/", config.tick_cpu);
  if (config.json)
    program::printJson(jsonOf(checks));
  else
    std::cout << textOf(checks);
  const bool required = config.realtime == rt::RealtimePolicy::kRequire;
  return required && !grantsRealtime(checks) ? program::kNotHeld : program::kDone;
}

void logModel(const MetaModel& model, const ServerConfig& config) {
  spdlog::info(describe(model, config.model.string()));
  spdlog::info(program::certificateLine(model.attributes().certificate));
}

int serve(int argc, char** argv) {
  // 1. Options.
  std::optional<ServerConfig> config;
  program::orUsageError([&] { config = parseCommandLine(argc, argv); });
  if (!config) return program::kDone;
  if (config->check_realtime) return tellMachine(*config);
  // 2. Signals wait for us, before any thread exists.
  prepareProcess();
  // before any thread exists too: what is made from here on stays off the tick's CPU.
  if (config->tick_cpu_alone) leaveCpuToTheTick(static_cast<int>(config->tick_cpu));
  // 3. The organ: immutable, checked, mapped.
  std::shared_ptr<const MetaModel> model(new const MetaModel(MetaModel::load(config->model)));
  logModel(*model, *config);
  // 4. From here on poses are answered.
  Server server(std::exchange(model, nullptr), *config);
  spdlog::info("serving on DDS domain {} at {} Hz", config->domain, config->rate);
  // 5. Until a signal says stop,
  const int signal = waitForSignal();
  // 6. zero force first, then everything else. Where a thread spins or hangs no destructor may wait for it.
  if (signal == SIGXCPU || !server.stop()) std::_Exit(program::kFailed);
  spdlog::info("signal {}: stopped", signal);
  return program::kDone;
}

}  // namespace
}  // namespace palpate::server

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-server", &palpate::server::serve, argc, argv);
}
