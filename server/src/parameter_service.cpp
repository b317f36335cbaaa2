// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/parameter_service.h"

#include <array>

#include "palpate/idl/error.h"

namespace palpate::server {

ParameterService::ParameterService(const dds::Participant& participant, Channels& channels,
                                   const Facts& facts)
    : channels_(channels),
      server_id_(facts.server_id),
      book_(facts),
      answers_(participant),
      requests_(participant) {
  if (!answers_.write(book_.answer())) throw dds::DdsError("cannot publish the parameters");
}

ParameterNews ParameterService::poll() {
  std::array<dds::ParameterRequest, dds::kMaxTake> requests;
  const std::size_t count = requests_.take(requests);
  ParameterNews news;
  for (std::size_t i = 0; i < count; ++i)
    if (requests[i].server_id == server_id_) serve(requests[i], news);
  return news;
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
  if (!answers_.write(answer)) channels_.failed_writes.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace palpate::server
