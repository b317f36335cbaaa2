// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/parameter_service.h"

#include <array>
#include <sstream>

#include "palpate/idl/error.h"

namespace palpate::server {
namespace {

std::string describe(const dds::ServerParameters& in_force) {
  std::ostringstream text;
  text << "E " << in_force.youngs_modulus << " Pa, friction " << in_force.friction << ", coupling "
       << in_force.coupling_stiffness << " N/m, " << in_force.coupling_damping << " N s/m, force limit "
       << in_force.force_limit << " N, " << in_force.force_rate_limit << " N/s";
  return text.str();
}

}  // namespace

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
    news.changed = "parameters, revision " + std::to_string(answer.revision) + ": " + describe(answer);
  }
  if (!answer.accepted) news.refused = std::string("parameters refused: ") + answer.message;
  // A lost answer: the client asks again.
  if (!answers_.write(answer)) channels_.failed_writes.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace palpate::server
