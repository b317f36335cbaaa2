// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/parameter_service.h"

#include <array>
#include <cstring>

#include "palpate/idl/error.h"
#include "palpate/rt/clock.h"

namespace palpate::server {
namespace {

std::string wordOf(bool said, const std::string& refusal) {
  if (!said) return ": its driver has left";
  return refusal.empty() ? ": its driver's word holds" : ": its driver's word is refused: " + refusal;
}

}  // namespace

ParameterService::ParameterService(const dds::Participant& participant, Channels& channels,
                                   const Facts& facts)
    : channels_(channels),
      facts_(facts),
      book_(facts),
      announcements_(participant, channels, facts),
      answers_(participant),
      requests_(participant, nullptr, this, &ParameterService::admits) {
  if (!publish(book_.answer())) throw dds::DdsError("cannot publish the parameters");
}

bool ParameterService::admits(const dds::ParameterRequest& request, void* context) noexcept {
  auto& self = *static_cast<ParameterService*>(context);
  std::atomic<std::uint64_t>* refused = nullptr;
  const bool this_run = request.session == 0 || request.session == self.facts_.session;
  if (request.server_id != self.facts_.server_id || !this_run) refused = &self.channels_.foreign_requests;
  if (refused == nullptr && !self.bucket_.take(rt::monotonicNow()))
    refused = &self.channels_.surplus_requests;
  if (refused != nullptr) refused->fetch_add(1, std::memory_order_relaxed);
  return refused == nullptr;
}

ParameterNews ParameterService::poll() {
  std::array<dds::ParameterRequest, dds::kMaxTake> requests;
  const std::size_t count = requests_.take(requests);
  ParameterNews news;
  noteModel(news);
  if (!leaving()) hearDrivers(news);
  for (std::size_t i = 0; i < count; ++i) serve(requests[i], news);
  return news;
}

void ParameterService::hearDrivers(ParameterNews& news) {
  if (poses_ == 0) return;
  const Announcements::ByTool said = announcements_.poll(poses_);
  std::string lines;
  for (std::size_t tool = 0; tool < said.size(); ++tool)
    if (book_.announced(tool, said[tool]))
      lines += (lines.empty() ? "tool " : "; tool ") + std::to_string(tool) +
               wordOf(said[tool].has_value(), book_.refusal(tool));
  if (lines.empty()) return;
  news.announced = lines + ": " + book_.describe();
  channels_.parameters.write(book_.inForce());
  if (!publish(book_.answer())) channels_.failed_writes.fetch_add(1, std::memory_order_relaxed);
}

void ParameterService::serve(const dds::ParameterRequest& request, ParameterNews& news) {
  if (request.model[0] != '\0') return serveModel(request, news);
  if (request.fields != 0 && leaving()) return;  // the client asks again
  const std::uint64_t before = book_.revision();
  const dds::ServerParameters answer = book_.decide(request);
  if (book_.revision() != before) {
    channels_.parameters.write(book_.inForce());
    news.changed = "parameters, revision " + std::to_string(answer.revision) + ": " + book_.describe();
  }
  if (!answer.accepted) news.refused = std::string("parameters refused: ") + answer.message;
  // A lost answer: the client asks again.
  if (!publish(answer)) channels_.failed_writes.fetch_add(1, std::memory_order_relaxed);
}

void ParameterService::serveModel(const dds::ParameterRequest& request, ParameterNews& news) {
  const std::uint64_t id = request.request_id;
  if (id != 0 && id == last_model_.request_id) return answerModel(id, last_model_.refusal, false);
  if (exchange_ != nullptr && exchange_->pending(id)) return answerModel(id, {}, true);
  std::string refusal = "this server takes no models from clients";
  if (request.fields != 0)
    refusal = "a request is for another model or for other values, not for both";
  else if (exchange_ != nullptr)
    refusal = exchange_->ask(std::string(request.model, strnlen(request.model, sizeof request.model)), id,
                             rt::monotonicNow());
  if (!refusal.empty()) news.refused = "model refused: " + refusal;
  answerModel(id, refusal, refusal.empty());
}

// What has become of the model that somebody asked for.
void ParameterService::noteModel(ParameterNews& news) {
  if (exchange_ == nullptr) return;
  const std::optional<ExchangeOutcome> outcome = exchange_->poll(rt::monotonicNow());
  if (!outcome) return;
  last_model_ = *outcome;
  if (!outcome->refusal.empty()) news.refused = "model refused: " + outcome->refusal;
  if (!outcome->line.empty()) news.model = outcome->line + "; " + book_.describe();
  answerModel(outcome->request_id, outcome->refusal, false);
}

void ParameterService::answerModel(std::uint64_t request_id, const std::string& refusal, bool pending) {
  dds::ServerParameters answer = book_.answer();
  answer.request_id = request_id;
  answer.accepted = refusal.empty();
  answer.pending = pending;
  dds::assignText(answer.message, refusal);
  if (!publish(answer)) channels_.failed_writes.fetch_add(1, std::memory_order_relaxed);
}

bool ParameterService::publish(dds::ServerParameters answer) {
  answer.session = facts_.session;
  dds::assignText(answer.model_id, facts_.model_id);
  answer.models = exchange_ != nullptr && exchange_->allowed();
  return answers_.write(answer);
}

}  // namespace palpate::server
