// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/parameter_service.h"

#include <array>

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
      server_id_(facts.server_id),
      session_(facts.session),
      book_(facts),
      announcements_(participant, channels, facts),
      answers_(participant),
      requests_(participant, nullptr, this, &ParameterService::admits) {
  if (!publish(book_.answer())) throw dds::DdsError("cannot publish the parameters");
}

bool ParameterService::admits(const dds::ParameterRequest& request, void* context) noexcept {
  auto& self = *static_cast<ParameterService*>(context);
  std::atomic<std::uint64_t>* refused = nullptr;
  const bool this_run = request.session == 0 || request.session == self.session_;
  if (request.server_id != self.server_id_ || !this_run) refused = &self.channels_.foreign_requests;
  if (refused == nullptr && !self.bucket_.take(rt::monotonicNow()))
    refused = &self.channels_.surplus_requests;
  if (refused != nullptr) refused->fetch_add(1, std::memory_order_relaxed);
  return refused == nullptr;
}

ParameterNews ParameterService::poll() {
  std::array<dds::ParameterRequest, dds::kMaxTake> requests;
  const std::size_t count = requests_.take(requests);
  ParameterNews news;
  hearDrivers(news);
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

bool ParameterService::publish(dds::ServerParameters answer) {
  answer.session = session_;
  return answers_.write(answer);
}

}  // namespace palpate::server
