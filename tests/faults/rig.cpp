// SPDX-License-Identifier: Apache-2.0
#include "rig.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <limits>
#include <thread>

#include "palpate/rt/process_threads.h"

namespace palpate::faults {
namespace {

using rt::kMs;
constexpr std::int64_t kSettled = 200 * kMs;  // right for so long
constexpr double kRight = 0.1;                // share by which a force may differ
constexpr double kLongest = 8'000.0;          // ms until it is given up
constexpr double kAllTries = 15'000.0;        // ms; no try begins later
constexpr int kMisses = 3;                    // tries without an excuse
constexpr double kBusy = 0.05;  // share of the time, stalled: nothing may be said of what takes long
constexpr std::int64_t kRecorded = 2000 * kMs;  // what a recording may lack, and how busy it was meanwhile
constexpr double kRecordingLacks =
    1500.0;  // ms: a flush each second (docs/recording_file.md), and a thread without priority

}  // namespace

void wait(milliseconds time) {
  std::this_thread::sleep_for(time);
}

Fault::Fault() : trace_file_(memfd_create("palpate-fault-trace", MFD_CLOEXEC)) {
  palpate::testing::writeSyntheticModel(model_.path());
  void* memory = MAP_FAILED;
  if (trace_file_ >= 0 && ftruncate(trace_file_, sizeof(Trace)) == 0)
    memory = mmap(nullptr, sizeof(Trace), PROT_READ | PROT_WRITE, MAP_SHARED, trace_file_, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no memory for a trace");
  trace_ = static_cast<Trace*>(memory);
  stalls_ = std::make_unique<palpate::testing::Stalls>(rt::usableCpus());
}

Fault::~Fault() {
  device_.reset();
  server_.reset();
  munmap(trace_, sizeof(Trace));
  close(trace_file_);
}

void Fault::startServer() {
  server_ = std::make_unique<ServerProcess>(server_arguments_);
}

void Fault::startDevice(const std::vector<std::string>& more) {
  const std::string trace = "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(trace_file_);
  std::vector<std::string> arguments{std::to_string(domain_), trace};
  arguments.insert(arguments.end(), more.begin(), more.end());
  device_ = std::make_unique<palpate::testing::ChildProcess>(
      PALPATE_FAULTS_DIR "/fault_device", arguments,
      palpate::testing::ChildProcess::Streams{-1, device_log_.descriptor()});
}

void Fault::useArguments(const std::vector<std::string>& more) {
  server_arguments_ = {"--model", model_.path().string(), "--domain", std::to_string(domain_), "--device",
                       "custom",  "--friction",           "inf",      "--listen-first",        "0.5"};
  server_arguments_.insert(server_arguments_.end(), more.begin(), more.end());
}

void Fault::start(const std::vector<std::string>& more) {
  useArguments(more);
  if (!server_) startServer();
  if (!device_) startDevice();
  ASSERT_NO_FATAL_FAILURE(waitUntilSettled());
}

bool Fault::bothRun() const {
  return server_->running() && device_->running();
}

// The size of the force that stays within a hundredth for kSettled from now on: before, another server may have been there.
void Fault::waitUntilSettled() {
  const std::int64_t from_ns = rt::monotonicNow();
  constexpr double kPatience = 6'000.0;  // ms
  for (; ms(rt::monotonicNow() - from_ns) < kPatience && bothRun(); wait(milliseconds(10))) {
    const std::int64_t since_ns = rt::monotonicNow() - kSettled;
    if (since_ns < from_ns) continue;
    const std::vector<Sample> samples = samplesSince(since_ns);
    if (samples.size() < 100) continue;
    const auto [least, most] = std::minmax_element(
        samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.force < b.force; });
    before_ = most->force;
    if (least->gain == 1.0 && least->force > 0.5 && least->force > 0.99 * most->force) return;
  }
  if (bothRun() && stalls_->between(from_ns, rt::monotonicNow()) > kBusy * kPatience)
    GTEST_SKIP() << "not judged: no force came that stays, on a machine that had no time for it";
  FAIL() << (bothRun() ? "no force came that stays: " : "server or device has ended: ") << server_->log()
         << device_log_.text();
}

std::vector<Sample> Fault::samplesSince(std::int64_t ns) const {
  const std::uint64_t count = trace_->count.load(std::memory_order_acquire);  // SYNC TRACE
  std::vector<Sample> samples;
  for (std::uint64_t i = count; i > 0 && count - i < trace_->samples.size() / 2; --i) {
    const Sample& sample = trace_->samples[(i - 1) % trace_->samples.size()];
    if (sample.at_ns < ns) break;
    samples.push_back(sample);
  }
  std::reverse(samples.begin(), samples.end());
  return samples;
}

bool Fault::isRight(const Sample& sample) const {
  return sample.gain == 1.0 && std::abs(sample.push - before_) < kRight * before_;
}

bool Fault::isRightSince(std::int64_t ns) const {
  const std::vector<Sample> samples = samplesSince(ns);
  return samples.size() > 50 &&
         std::all_of(samples.begin(), samples.end(), [this](const Sample& s) { return isRight(s); });
}

Outcome Fault::judge(std::int64_t from_ns, std::int64_t end_ns) const {
  const std::vector<Sample> samples = samplesSince(from_ns);
  Outcome outcome;
  outcome.smallest = outcome.largest = 1.0;
  std::int64_t wrong_ns = from_ns;
  for (const Sample& sample : samples) {
    outcome.smallest = std::min(outcome.smallest, sample.push / before_);
    outcome.largest = std::max(outcome.largest, sample.force / before_);
    if (sample.force == 0.0 && !outcome.zero_ms) outcome.zero_ms = ms(sample.at_ns - from_ns);
    if (!isRight(sample)) wrong_ns = sample.at_ns;
  }
  if (!samples.empty() && samples.back().at_ns - wrong_ns >= kSettled / 2)
    outcome.again_ms = std::max(0.0, ms(wrong_ns - end_ns));
  return outcome;
}

Fault::Complaint Fault::complaint(const Outcome& outcome, Force wanted, double lasts, std::int64_t from_ns,
                                  std::int64_t end_ns) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  constexpr double kDips = 10.0, kStays = 30.0;  // ms without a processor that let a force fall, or keep it
  const std::int64_t now_ns = rt::monotonicNow();
  const auto during = [&](std::string text, double explained_by) {
    return Complaint{std::move(text), explained_by, from_ns, now_ns};
  };
  if (outcome.largest > 1.0 + kRight) return {"a force larger than before", kNever, from_ns, now_ns, true};
  if (outcome.smallest < 0.0) return {"a force that pulls", kNever, from_ns, now_ns, true};
  if (const std::string more = also_ ? also_() : std::string(); !more.empty()) return during(more, kNever);
  if (wanted == Force::kZero && !outcome.zero_ms) return during("the force was never zero", kStays);
  const bool stays = outcome.smallest >= 1.0 - kRight;
  const double zero_ms = outcome.zero_ms.value_or(0.0);
  if (wanted == Force::kGoesOn && !stays) return during("the force did not go on", kDips);
  if (wanted == Force::kEither && !stays && (!outcome.zero_ms || zero_ms > kZeroWithin + kOnTheWay))
    return during("the force neither went on nor was zero at once", kDips);
  if (wanted == Force::kZero && zero_ms > kZeroWithin + kOnTheWay)
    return {"zero after " + std::to_string(zero_ms) + " ms", zero_ms - kZeroWithin - kOnTheWay, from_ns,
            from_ns + static_cast<std::int64_t>(1e6 * zero_ms)};
  if (outcome.again_ms.value_or(kNever) > lasts)
    return during("the force was not right again within " + std::to_string(lasts) + " ms",
                  kBusy * ms(now_ns - from_ns));
  if (outcome.recording_lacks_ms.value_or(0.0) > kRecordingLacks)
    return {"the recording lacks " + std::to_string(*outcome.recording_lacks_ms) + " ms",
            kBusy * ms(kRecorded), from_ns - kRecorded, end_ns};
  return {};
}

void Fault::waitUntilRight(std::int64_t end_ns) const {
  const auto stays = [&] {
    return rt::monotonicNow() > end_ns + 400 * kMs && isRightSince(rt::monotonicNow() - kSettled);
  };
  while (ms(rt::monotonicNow() - end_ns) < kLongest && bothRun() && !stays()) wait(milliseconds(10));
}

void Fault::expect(const std::string& fault, Force wanted, const std::function<void()>& inject,
                   double lasts) {
  if (IsSkipped()) return;
  std::string complaints;
  int tries = 0, misses = 0;
  for (const std::int64_t start_ns = rt::monotonicNow();
       misses < kMisses && ms(rt::monotonicNow() - start_ns) < kAllTries; ++tries) {
    if (prepare_) prepare_();
    ASSERT_NO_FATAL_FAILURE(waitUntilSettled());
    if (IsSkipped()) return;
    const std::int64_t from_ns = rt::monotonicNow();
    inject();
    if (HasFatalFailure()) return;
    const std::int64_t end_ns = rt::monotonicNow();
    waitUntilRight(end_ns);
    Outcome outcome = judge(from_ns, end_ns);
    outcome.fault = fault;
    outcome.recording_lacks_ms = recording_lacks_ms_;
    if (server_zero_ms_) outcome.zero_ms = server_zero_ms_;
    const Complaint complaint = this->complaint(outcome, wanted, lasts, from_ns, end_ns);
    if (complaint.text.empty()) return tell(outcome);
    if (complaint.harms) {
      tell(outcome);
      FAIL() << fault << ": " << complaint.text << "\n" << server_->log();
    }
    const double stalled = stalls_->between(complaint.from_ns, complaint.until_ns);
    if (stalled < complaint.explained_by) ++misses;
    complaints += complaint.text + " (stalled for " + std::to_string(stalled) + " ms); ";
    if (misses == kMisses) tell(outcome);
  }
  if (misses < kMisses && misses < tries)
    GTEST_SKIP() << "not judged: " << fault << ": this machine stalled in " << tries - misses << " of "
                 << tries << " tries: " << complaints;
  FAIL() << fault << ": " << complaints << server_->log();
}

}  // namespace palpate::faults
