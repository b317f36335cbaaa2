// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/recorder.h"

#include <chrono>
#include <thread>

namespace palpate::server {
namespace {

constexpr auto kPoll = std::chrono::milliseconds(10);
constexpr int kPollsPerFlush = 100;  // about once per second; a killed server loses no more

}  // namespace

Recorder::Recorder(Channels& channels, const std::filesystem::path& path, const record::SessionFacts& facts)
    : channels_(channels), path_(path), writer_(path, facts) {
  channels_.recording = std::make_unique<rt::SpscQueue<record::RecordedTick, 16384>>();
}

void Recorder::run() noexcept {
  try {
    bool stopping = false;
    for (int polls = 1; !stopping; ++polls) {
      std::this_thread::sleep_for(kPoll);
      stopping = channels_.stopping.load(std::memory_order_acquire);  // SYNC STOP
      drain();
      if (polls % kPollsPerFlush == 0) writer_.flush();
    }
    writer_.finish(writer_.ticks() + channels_.unrecorded.load(std::memory_order_relaxed));
  } catch (const std::exception& error) {
    failure_ = error.what();
    channels_.recording_failed.store(true, std::memory_order_relaxed);
  }
}

void Recorder::drain() {
  record::RecordedTick tick;
  while (channels_.recording->pop(tick)) writer_.write(tick);
}

std::string Recorder::summary() const {
  if (!failure_.empty())
    return "recording ends early after " + std::to_string(writer_.ticks()) + " ticks: " + failure_;
  const std::uint64_t lost = channels_.unrecorded.load(std::memory_order_relaxed);
  return "recorded " + std::to_string(writer_.ticks()) + " ticks to " + path_.string() + ", " +
         std::to_string(lost) + " lost";
}

}  // namespace palpate::server
