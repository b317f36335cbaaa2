// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "palpate/server/channels.h"
#include "palpate/server/facts.h"
#include "palpate/server/model_loader.h"
#include "palpate/server/parameter_book.h"
#include "palpate/server/recorder.h"
#include "palpate/server/rest_surface.h"

namespace palpate::server {

/// How a request for another model ended.
struct ExchangeOutcome {
  std::uint64_t request_id{0};
  std::string refusal;  ///< empty: the model answers poses from now on
  std::string line;     ///< for the log, when it was taken
};

/// What the exchange changes beside the engine. All must outlive it.
struct Served {
  Facts& facts;  ///< of these the model's: model_id, model_hash, organ, memory_locked
  ParameterBook& parameters;
  RestSurface& surface;
  Recorder* recorder;  ///< none: nothing is recorded
};

/// Has another model answer poses (docs/decisions/swap.md). Owns the engine in use, and the one that is to follow:
///   loading   the loader checks and maps a model beside the one in use
///   leaving   the tick has been offered its engine, ends all forces, and takes it
///   clearing  the surface's thread lets go of the engine before; the loader frees that
/// Threads: one, the events thread. Real-time: no.
class ModelExchange {
 public:
  /// @param[in] loader  none: every request is refused
  ModelExchange(Channels& channels, const Served& served, std::unique_ptr<Engine> first,
                std::unique_ptr<ModelLoader> loader);

  /// After a look at a model, taken or refused, requests are refused for as long as it took, and at least for this: nobody keeps the forces
  /// at zero by asking, or the loader's thread busy.
  static constexpr std::int64_t kRest = 1'000'000'000;  // ns

  /// The session is recorded: each model gets a file of its own. Before the first poll().
  void recordBy(Recorder& recorder) noexcept { served_.recorder = &recorder; }
  [[nodiscard]] bool allowed() const noexcept { return loader_ != nullptr; }
  /// @return why the model cannot be had; empty: poll() will tell
  [[nodiscard]] std::string ask(const std::string& name, std::uint64_t request_id, std::int64_t now_ns);
  /// Whether this request's answer is still to come.
  [[nodiscard]] bool pending(std::uint64_t request_id) const noexcept { return asker_ == request_id; }
  /// The settings in force are part of the engine that was offered: nobody changes them now.
  [[nodiscard]] bool leaving() const noexcept { return state_ == State::kLeaving; }
  /// Goes on as far as the other threads are. @return how the request ended, once
  [[nodiscard]] std::optional<ExchangeOutcome> poll(std::int64_t now_ns);

 private:
  enum class State { kResting, kLoading, kLeaving, kClearing };
  void restFrom(std::int64_t now_ns) noexcept;
  [[nodiscard]] ExchangeOutcome end(const std::string& refusal);
  [[nodiscard]] std::optional<ExchangeOutcome> offer(LoadedModel loaded);
  [[nodiscard]] ExchangeOutcome take(std::int64_t now_ns);

  Channels& channels_;
  Served served_;
  State state_{State::kResting};
  std::uint64_t asker_{0};  // request_id; 0: nobody waits
  std::string name_;        // of the model that was asked for
  std::int64_t asked_ns_{0};
  std::int64_t rests_until_ns_{0};
  std::unique_ptr<Engine> engine_;
  std::unique_ptr<Engine> next_;    // while leaving
  LoadedModel loaded_;              // what goes with it
  std::string record_;              // the file that its session goes to; empty: nothing is recorded
  std::unique_ptr<Engine> former_;  // while clearing
  std::unique_ptr<ModelLoader> loader_;
};

}  // namespace palpate::server
