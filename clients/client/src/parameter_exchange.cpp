// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/parameter_exchange.h"

#include <array>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "palpate/client/error.h"
#include "palpate/client/no_server.h"
#include "palpate/client/request_id.h"
#include "palpate/client/stop_signal.h"
#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"

namespace palpate::client {
namespace {

using Clock = std::chrono::steady_clock;

// The first answer to a request, and who else answers it. One that says that another follows only says that there is a server.
struct Answers {
  std::optional<dds::ServerParameters> first;
  bool pending{false};  // since the last look
  std::set<dds::WriterId> writers;

  void take(std::uint64_t request_id, const dds::Reader<dds::ServerParameters>& reader) {
    std::array<dds::ServerParameters, dds::kMaxTake> samples;
    std::array<dds::WriterId, dds::kMaxTake> from;
    const std::size_t count = reader.view().take(samples, from);
    for (std::size_t i = 0; i < count; ++i) {
      if (samples[i].request_id != request_id) continue;
      writers.insert(from[i]);
      if (samples[i].pending)
        pending = true;
      else if (!first)
        first = samples[i];
    }
  }
};

// Two servers of one id take the same request, each for itself.
dds::ServerParameters onlyAnswer(const Answers& answers) {
  if (answers.writers.size() > 1)
    throw ClientError(std::to_string(answers.writers.size()) + " servers have the id " +
                      std::to_string(answers.first->server_id) +
                      " and each took the request for itself: stop all but one");
  return *answers.first;
}

std::string missing(std::uint32_t server_id, const dds::Participant& participant,
                    const dds::Reader<dds::ServerParameters>& answers, std::chrono::milliseconds waited) {
  const std::string text =
      "no server " + std::to_string(server_id) + " answered" + where(participant.domain(), waited);
  const std::string mismatch = answers.mismatch();
  return mismatch.empty() ? text + kNoServerHint : text + "; " + mismatch;
}

// What a server answered last, to whomever.
dds::ServerParameters newestAnswer(const dds::Participant& participant, const dds::ParameterRequest& question,
                                   std::chrono::milliseconds patience) {
  const dds::Reader<dds::ServerParameters> answers(participant);
  const Clock::time_point end = Clock::now() + patience;
  std::array<dds::ServerParameters, dds::kMaxTake> samples;
  while (Clock::now() <= end && !stopRequested()) {
    for (std::size_t i = answers.view().take(samples); i-- > 0;)
      if (!samples[i].pending && samples[i].server_id == question.server_id &&
          (question.session == 0 || samples[i].session == question.session))
        return samples[i];
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (stopRequested()) throw ClientError("interrupted while waiting for a server");
  throw ClientError(missing(question.server_id, participant, answers, patience));
}

}  // namespace

dds::ServerParameters exchangeParameters(const dds::Participant& participant, dds::ParameterRequest request,
                                         std::chrono::milliseconds patience) {
  if (!participant.mayWrite(dds::TopicTraits<dds::ParameterRequest>::kName)) {
    if (request.fields != 0 || request.model[0] != '\0')
      throw ClientError("the identity " + participant.identity()->name() + " has the role " +
                        std::string(dds::wordOf(participant.identity()->role())) +
                        ", only an operator may change parameters");
    return newestAnswer(participant, request, patience);
  }
  dds::Writer<dds::ParameterRequest> requests(participant);
  const dds::Reader<dds::ServerParameters> answers(participant);
  request.request_id = firstRequestId();
  Clock::time_point end = Clock::now() + patience;
  constexpr auto kLinger = std::chrono::milliseconds(50);  // for another server of the same id
  Clock::time_point next = Clock::now();
  std::optional<Clock::time_point> answered;
  Answers found;
  while (Clock::now() <= end && !stopRequested()) {
    if (requests.matched() == 0) next = Clock::now() + kLinger;
    if (Clock::now() >= next) {
      (void)requests.write(request);
      next = Clock::now() + std::chrono::milliseconds(200);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    found.take(request.request_id, answers);
    if (std::exchange(found.pending, false)) end = Clock::now() + patience;
    if (found.first && !answered) answered = Clock::now();
    if (answered && Clock::now() - *answered >= kLinger) return onlyAnswer(found);
  }
  if (found.first) return onlyAnswer(found);
  if (stopRequested()) throw ClientError("interrupted while waiting for a server");
  throw ClientError(missing(request.server_id, participant, answers, patience));
}

}  // namespace palpate::client
