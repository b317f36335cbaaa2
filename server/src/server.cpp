// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/server.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "palpate/idl/certificate.h"
#include "palpate/rt/memory.h"
#include "palpate/rt/spin_guard.h"
#include "palpate/server/startup.h"
#include "palpate/server/urgent_mappings.h"

namespace palpate::server {
namespace {

std::int64_t periodOf(const ServerConfig& config) {
  return std::llround(1e9 / config.rate);
}

TickPlan planOf(const ServerConfig& config) {
  const double surface_rate = std::min(config.surface_rate, config.rate);
  return {periodOf(config), std::llround(1e9 / surface_rate), config.phase_lock};
}

std::unique_ptr<ModelLoader> loaderOf(const ServerConfig& config) {
  return config.models.empty() ? nullptr : std::make_unique<ModelLoader>(config.models);
}

const char* reasonNotLocked(const rt::MemoryLock& lock) {
  if (!lock.present) return std::strerror(lock.refused);
  return lock.future ? "the model is not" : "under a limit, only what exists by now is";
}

void tellOfMemory(bool locked, const rt::MemoryLock& lock) {
  if (locked) {
    spdlog::info("memory: locked");
  } else {
    spdlog::warn("memory: not locked ({}), a tick may wait for a page; raise ulimit -l or grant CAP_IPC_LOCK",
                 reasonNotLocked(lock));
  }
}

// With an identity two servers hear of each other only after a handshake.
double listenFirst(const ServerConfig& config) {
  constexpr double kHandshake = 1.0;  // s
  return config.listen_first > 0.0 && !config.security.empty() ? config.listen_first + kHandshake
                                                               : config.listen_first;
}

// What a tick's thread gets, tried once before any thread exists. @throw rt::RealtimeError under policy
// require
bool probeRealtime(rt::RealtimePolicy policy) {
  const rt::Thread probe({"tick", kTickPriority, policy, {}}, [] {});
  return probe.realtime();
}

std::string describeRealtime(rt::RealtimePolicy policy, bool realtime) {
  if (realtime) return "SCHED_FIFO, tick at priority " + std::to_string(kTickPriority);
  if (policy == rt::RealtimePolicy::kOff) return "off, as asked";
  return "not granted; run as root, grant CAP_SYS_NICE or raise ulimit -r to " +
         std::to_string(kTickPriority);
}

// How long a stop waits for the tick, for what is recorded (a disk may stall for as long as the ring of ticks lasts), and for those who
// write to DDS together: with zero force, at most 4 s, less than TimeoutStopSec of the unit.
constexpr std::chrono::seconds kTickEnds{1}, kRecordingEnds{5}, kSendersEnd{1};

// Waits for threads, of which one may hang, in DDS or at a disk.
class Patience {
 public:
  explicit Patience(std::chrono::seconds longest) : longest_(longest) {}

  // @param thread  rt::Thread or rt::PeriodicThread, or null
  template <class Thread>
  [[nodiscard]] bool endOf(const std::unique_ptr<Thread>& thread, const char* name) const {
    using std::chrono::milliseconds;
    const auto left = std::chrono::duration_cast<milliseconds>(until_ - Clock::now());
    if (!thread || thread->joinWithin(std::max(left, milliseconds(0)))) return true;
    spdlog::critical("thread {} hangs: the server ends without it after {} s", name, longest_.count());
    return false;
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::chrono::seconds longest_;
  Clock::time_point until_{Clock::now() + longest_};
};

}  // namespace

Server::Server(const std::shared_ptr<const MetaModel>& model, const ServerConfig& config)
    : facts_(factsOf(*model, config)),
      first_(std::make_unique<Engine>(model, facts_.step)),
      participant_(static_cast<std::uint32_t>(config.domain),
                   dds::identityFor({dds::Role::kServer}, config.security)),
      status_out_(participant_, facts_),
      rivals_(participant_, facts_, status_out_, listenFirst(config)),
      force_out_(participant_, channels_, facts_),
      rest_surface_(participant_, facts_, std::make_unique<const OrganShape>(*model)),
      surface_out_(participant_, channels_, facts_),
      parameters_(participant_, channels_, facts_),
      events_(channels_, status_out_, parameters_, rivals_),
      tick_(*first_, channels_, planOf(config)),
      exchange_(channels_, {facts_, parameters_.book(), rest_surface_, nullptr}, std::move(first_),
                loaderOf(config)),
      poses_in_(participant_, channels_, config.step, {facts_.server_id, facts_.answers_any}),
      endpoints_(participant_),
      processes_(participant_),
      ramp_time_(config.step.ramp_time) {
  watchEndpoints();
  startSecurity();
  parameters_.listenToDrivers(poses_in_.handle());
  parameters_.serveModels(exchange_);
  if (!config.record.empty()) {
    recorder_.emplace(channels_, config.record, sessionOf(*model, facts_.step));
    exchange_.recordBy(*recorder_);
  }
  Startup startup{config.realtime, rt::lockMemory(), model->locked(), false, {}};
  facts_.process_locked = startup.memory.present && startup.memory.future;
  facts_.memory_locked = facts_.process_locked && model->locked();
  tellOfMemory(facts_.memory_locked, startup.memory);
  settleRealtime(config.realtime);
  tellOfContact();
  try {
    startThreads(config);
    startup.awake = awake_ && awake_->held();
    startup.threads = rt::threadsOfThisProcess();
    for (const std::string& line : startupTable(startup)) spdlog::info(line);
    for (const std::string& line : remedies(startup)) spdlog::warn(line);
    tellServiceManager(config);
  } catch (const std::exception& error) {
    if (stop()) throw;
    spdlog::critical("{}", error.what());  // a thread hangs, which destructors would wait for
    std::_Exit(EXIT_FAILURE);
  }
}

void Server::watchEndpoints() {
  poses_in_.show(endpoints_);
  force_out_.show(endpoints_);
  rest_surface_.show(endpoints_);
  surface_out_.show(endpoints_);
  status_out_.show(endpoints_);
  parameters_.show(endpoints_);
  events_.serveStrangers(endpoints_, rest_surface_);
  events_.lookForOwners(processes_, poses_in_.handle());
}

void Server::startSecurity() {
  const std::optional<dds::Identity>& identity = participant_.identity();
  if (!identity) return;
  spdlog::info("topics are signed and encrypted; this is {}, until {}", identity->name(),
               dds::utcOf(identity->expires()));
  events_.watchSecurity(security_.emplace(participant_));
}

void Server::settleRealtime(rt::RealtimePolicy policy) {
  facts_.realtime = probeRealtime(policy);
  facts_.realtime_detail = describeRealtime(policy, facts_.realtime);
  if (facts_.realtime || policy == rt::RealtimePolicy::kOff) {
    spdlog::info("real time: {}", facts_.realtime_detail);
  } else {
    spdlog::warn("real time: {}", facts_.realtime_detail);
  }
  urgent_mappings.store(facts_.realtime, std::memory_order_relaxed);
  if (!facts_.realtime) return;
  events_.raiseReceiveThreads();
  if (const int error = rt::limitRealtimeWithoutSleep(kLongestComputation, kLastComputation); error != 0)
    spdlog::warn("real time: RLIMIT_RTTIME is refused ({}): a thread that spins would take the machine",
                 std::strerror(error));
  awake_.emplace();
  if (!awake_->held()) spdlog::warn("real time: /dev/cpu_dma_latency cannot be held, wake-ups may be late");
  if (rt::raiseThreadsNamed(kReceiveThreads, kReceivePriority) == 0) {
    spdlog::warn("real time: no receive thread of DDS was found to raise");
  }
}

// Before there are threads: another model changes what it reads.
void Server::tellOfContact() const {
  spdlog::info("{}; {} tools; the organ has up to {:.0f} N/m at {:g} Pa", parameters_.book().describe(),
               facts_.step.tools, facts_.organ.largest, facts_.organ.youngs_modulus);
}

void Server::startThreads(const ServerConfig& config) {
  const rt::RealtimePolicy policy = config.realtime;
  const auto start = [policy](const char* name, int priority, std::function<void()> body) {
    return std::make_unique<rt::Thread>(rt::ThreadOptions{name, priority, policy, {}}, std::move(body));
  };
  force_thread_ = start("force-out", kForcePriority, [this] { force_out_.run(); });
  surface_thread_ = start("surface-out", kSurfacePriority, [this] { surface_out_.run(); });
  events_thread_ = start("events", 0, [this] { events_.run(); });
  if (recorder_) recorder_thread_ = start("recorder", 0, [this] { recorder_->run(); });
  rt::ThreadOptions tick{"tick", kTickPriority, policy, {}};
  if (config.tick_cpu != kAnyCpu) tick.cpus = {static_cast<int>(config.tick_cpu)};
  tick_thread_ = std::make_unique<rt::PeriodicThread>(
      tick, periodOf(config), &Tick::onCycle, &tick_, rt::LateListener{&Tick::onLate, &channels_},
      rt::Rehearsal{&Tick::onRehearsal, &tick_, rt::rehearsalLead(periodOf(config))});
  late_watch_.emplace(channels_, *tick_thread_, tick_thread_->realtime() ? kTickPriority : 0);
  late_thread_ = start("late-watch", 0, [this] { late_watch_->run(); });
}

void Server::tellServiceManager(const ServerConfig& config) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), "READY=1\nSTATUS=serving on DDS domain %d at %g Hz",
                static_cast<int>(config.domain), config.rate);
  service_.tell(text.data());
  if (service_.patience().count() == 0) return;
  watchdog_.emplace(service_, *tick_thread_, channels_.force_rounds,
                    static_cast<std::uint32_t>(config.domain));
  watchdog_thread_ = std::make_unique<rt::Thread>(rt::ThreadOptions{"watchdog", 0, config.realtime, {}},
                                                  [this] { watchdog_->run(); });
}

bool Server::stop() {
  bool ended = true;
  if (tick_thread_) {
    if (watchdog_) watchdog_->stopping();
    const bool sent = sendZeroForce();
    channels_.zero_force_out.store(sent, std::memory_order_relaxed);
    service_.tell(sent ? "STOPPING=1\nSTATUS=no forces any more"
                       : "STOPPING=1\nSTATUS=zero force could not be sent");
    const bool joined = Patience(kTickEnds).endOf(tick_thread_, "tick");
    if (joined) spdlog::info("page faults in ticks: {}", tick_thread_->pageFaults());
    ended = sent && joined;
  }
  channels_.stopping.store(true, std::memory_order_release);  // SYNC STOP
  channels_.force_ready.post();
  channels_.surface_ready.post();
  channels_.late_watch_ready.post();
  late_thread_.reset();  // its last word is for events; it waits for nobody
  channels_.events_ready.post();
  if (recorder_thread_ && Patience(kRecordingEnds).endOf(recorder_thread_, "recorder")) {
    recorder_thread_.reset();
    spdlog::info(recorder_->summary());
  }
  ended = ended && !recorder_thread_;
  const Patience patience(kSendersEnd);
  for (const auto& [thread, name] :
       {std::pair(&force_thread_, "force-out"), std::pair(&surface_thread_, "surface-out"),
        std::pair(&events_thread_, "events")})
    ended = patience.endOf(*thread, name) && ended;
  if (watchdog_) watchdog_->end();
  watchdog_thread_.reset();
  watchdog_.reset();
  if (ended) tick_thread_.reset();
  return ended;
}

bool Server::sendZeroForce() {
  // The ramp, the zero ticks at the slowest rate, and a host that stalls.
  const auto longest_ns = static_cast<std::int64_t>(1e9 * (ramp_time_ + 3.0));
  channels_.shutting_down.store(true, std::memory_order_relaxed);
  return channels_.zero_force_sent.waitFor(longest_ns);
}

}  // namespace palpate::server
