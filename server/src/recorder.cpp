// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/recorder.h"

#include <chrono>
#include <thread>

namespace palpate::server {
namespace {

constexpr auto kPoll = std::chrono::milliseconds(10);
constexpr int kPollsPerFlush = 100;  // about once per second; a killed server loses no more

}  // namespace

record::SessionFacts sessionOf(const MetaModel& model, const StepConfig& config) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return {model.digest(), std::chrono::duration_cast<std::chrono::nanoseconds>(now).count(), config};
}

Recorder::Recorder(Channels& channels, const std::filesystem::path& path, const record::SessionFacts& facts)
    : channels_(channels), first_path_(path), path_(path) {
  writer_.emplace(path, facts);
  channels_.recording = std::make_unique<rt::SpscQueue<SessionTick, 16384>>();
}

std::filesystem::path Recorder::expect(std::uint64_t engine, const record::SessionFacts& facts) {
  std::filesystem::path path;
  if (files_ >= kMostFiles)
    throw record::RecordError(first_path_.string() + ": this session has " + std::to_string(kMostFiles) +
                              " files for its models, and gets no more");
  do {
    path = first_path_.parent_path() /
           (first_path_.stem().string() + "-" + std::to_string(++number_) + first_path_.extension().string());
  } while (std::filesystem::exists(path));  // of an earlier session
  ++files_;
  const std::lock_guard lock(mutex_);
  expected_.insert_or_assign(engine, Next{path, facts});
  return path;
}

void Recorder::run() noexcept {
  try {
    bool stopping = false;
    for (int polls = 1; !stopping; ++polls) {
      std::this_thread::sleep_for(kPoll);
      stopping = channels_.stopping.load(std::memory_order_acquire);  // SYNC STOP
      drain();
      if (polls % kPollsPerFlush == 0) writer_->flush();
    }
    finish(channels_.unrecorded.load(std::memory_order_relaxed));
  } catch (const std::exception& error) {
    failure_ = error.what();
    channels_.recording_failed.store(true, std::memory_order_relaxed);
  }
}

void Recorder::drain() {
  SessionTick next;
  while (channels_.recording->pop(next)) {
    if (next.engine != engine_) goOn(next);
    writer_->write(next.tick);
  }
}

// `unrecorded`: ticks lost before the end of this file.
void Recorder::finish(std::uint64_t unrecorded) {
  writer_->finish(writer_->ticks() + unrecorded - unrecorded_);
  unrecorded_ = unrecorded;
}

// Another file for another model. The ring is seconds deep, so what is lost by now may be of any engine: the first tick that
// came of this one says how many were lost before it, and by its index how many of these were of this engine.
void Recorder::goOn(const SessionTick& first) {
  finish(first.unrecorded - first.tick.index);
  finished_ += path_.string() + " (" + std::to_string(writer_->ticks()) + " ticks), ";
  Next next;
  {
    const std::lock_guard lock(mutex_);
    next = expected_.at(first.engine);
    expected_.erase(expected_.begin(), expected_.upper_bound(first.engine));
  }
  engine_ = first.engine;
  path_ = next.path;
  writer_.emplace(path_, next.facts);
}

std::string Recorder::summary() const {
  if (!failure_.empty())
    return "recording ends early after " + std::to_string(writer_ ? writer_->ticks() : 0) +
           " ticks: " + failure_;
  const std::uint64_t lost = channels_.unrecorded.load(std::memory_order_relaxed);
  return "recorded " + std::to_string(writer_->ticks()) + " ticks to " + path_.string() + ", " +
         std::to_string(lost) + " lost" +
         (finished_.empty() ? "" : "; before that " + finished_ + "of other models");
}

}  // namespace palpate::server
