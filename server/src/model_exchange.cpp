// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/model_exchange.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "tools/program/certificate_line.h"

namespace palpate::server {

ModelExchange::ModelExchange(Channels& channels, const Served& served, std::unique_ptr<Engine> first,
                             std::unique_ptr<ModelLoader> loader)
    : channels_(channels), served_(served), engine_(std::move(first)), loader_(std::move(loader)) {}

std::string ModelExchange::ask(const std::string& name, std::uint64_t request_id, std::int64_t now_ns) {
  if (!loader_)
    return "this server takes no models from clients: its operator named no folder of models (--models)";
  if (request_id == 0) return "request_id is 0: an answer could not be told from others";
  if (const std::string complaint = ModelsFolder::complaintAbout(name); !complaint.empty()) return complaint;
  if (state_ != State::kResting) return "another model is on its way: \"" + name_ + "\"";
  if (now_ns < rests_until_ns_)
    return fmt::format("a model was looked at a moment ago, the next one may be asked for in {:.1f} s",
                       1e-9 * static_cast<double>(rests_until_ns_ - now_ns));
  state_ = State::kLoading;
  asked_ns_ = now_ns;
  asker_ = request_id;
  name_ = name;
  loader_->load(name);
  return {};
}

std::optional<ExchangeOutcome> ModelExchange::poll(std::int64_t now_ns) {
  if (state_ == State::kLoading)
    if (std::optional<LoadedModel> loaded = loader_->poll()) {
      restFrom(now_ns);
      return offer(std::move(*loaded));
    }
  if (state_ == State::kLeaving &&
      channels_.engine_in_use.load(std::memory_order_acquire) == next_->number)  // SYNC TAKEN
    return take(now_ns);
  if (state_ == State::kClearing &&
      channels_.engine_shown.load(std::memory_order_acquire) == engine_->number) {  // SYNC SHOWN
    loader_->discard(std::move(former_));
    state_ = State::kResting;
  }
  return std::nullopt;
}

void ModelExchange::restFrom(std::int64_t now_ns) noexcept {
  rests_until_ns_ = now_ns + std::max(now_ns - asked_ns_, kRest);
}

// The request is over, and nothing has changed unless its model was taken.
ExchangeOutcome ModelExchange::end(const std::string& refusal) {
  state_ = State::kResting;
  return {std::exchange(asker_, 0), refusal, {}};
}

std::optional<ExchangeOutcome> ModelExchange::offer(LoadedModel loaded) {
  if (!loaded.model) return end(loaded.refusal);
  std::string refusal = served_.parameters.complaintAbout(loaded.organ);
  const bool same = loaded.model->digest() == engine_->model->digest();
  try {
    if (refusal.empty() && !same) {
      StepConfig config = served_.facts.step;
      config.organ_stiffness = loaded.organ.largest;
      const AllToolSettings settings = served_.parameters.inForceOnNext();
      for (std::size_t tool = 0; tool < settings.size(); ++tool) config.own[tool] = settings[tool];
      next_ = std::make_unique<Engine>(loaded.model, config, engine_->number + 1);
      if (served_.recorder != nullptr)
        record_ = served_.recorder->expect(next_->number, sessionOf(*loaded.model, config)).string();
    }
  } catch (const std::exception& error) {
    refusal = name_ + ": " + error.what();
  }
  if (!refusal.empty() || same) {
    next_.reset();
    loader_->discard(std::move(loaded));
    return end(refusal);
  }
  loaded_ = std::move(loaded);
  state_ = State::kLeaving;
  channels_.next_engine.store(next_.get(), std::memory_order_release);  // SYNC ENGINE
  return std::nullopt;
}

ExchangeOutcome ModelExchange::take(std::int64_t now_ns) {
  former_ = std::exchange(engine_, std::move(next_));
  served_.facts.model_id = engine_->id;
  served_.facts.model_hash = engine_->hash;
  served_.facts.organ = loaded_.organ;
  served_.facts.memory_locked = served_.facts.process_locked && engine_->model->locked();
  served_.parameters.take(loaded_.organ);
  if (!served_.surface.change(std::move(loaded_.shape)))
    channels_.failed_writes.fetch_add(1, std::memory_order_relaxed);
  channels_.engine_to_show.store(engine_->number, std::memory_order_release);  // SYNC SHOWN
  channels_.surface_ready.post();
  ExchangeOutcome outcome = end({});
  outcome.line = "another organ: " + describe(*engine_->model, loaded_.name) + "; " +
                 program::certificateLine(engine_->model->attributes().certificate);
  if (!engine_->model->locked()) outcome.line += "; not locked into memory, a tick may wait for a page";
  if (!record_.empty() && !channels_.recording_failed.load(std::memory_order_relaxed))
    outcome.line += "; the recording goes on in " + record_;
  loaded_ = {};
  state_ = State::kClearing;
  rests_until_ns_ = std::max(rests_until_ns_, now_ns + kRest);
  return outcome;
}

}  // namespace palpate::server
