// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/parameter_exchange.h"

#include <array>
#include <functional>
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

using Fits = std::function<bool(const dds::ServerParameters&)>;

// The newest answer that fits, and who else sends such ones. One that says that another follows only says that there is a server.
struct Answers {
  std::optional<dds::ServerParameters> newest;
  bool pending{false};  // since the last look
  std::set<dds::WriterId> writers;

  void take(const dds::Reader<dds::ServerParameters>& reader, const Fits& fits) {
    std::array<dds::ServerParameters, dds::kMaxTake> samples;
    std::array<dds::WriterId, dds::kMaxTake> from;
    const std::size_t count = reader.view().take(samples, from);
    for (std::size_t i = 0; i < count; ++i) {
      if (!fits(samples[i])) continue;
      writers.insert(from[i]);
      if (samples[i].pending)
        pending = true;
      else
        newest = samples[i];
    }
  }
};

// Two servers of one id take the same request, each for itself.
dds::ServerParameters onlyAnswer(const Answers& answers) {
  if (answers.writers.size() > 1)
    throw ClientError(std::to_string(answers.writers.size()) + " servers have the id " +
                      std::to_string(answers.newest->server_id) +
                      " and each answers for itself: stop all but one");
  return *answers.newest;
}

std::string missing(std::uint32_t server_id, const dds::Participant& participant,
                    const dds::Reader<dds::ServerParameters>& answers, std::chrono::milliseconds waited) {
  const std::string text =
      "no server " + std::to_string(server_id) + " answered" + where(participant.domain(), waited);
  const std::string mismatch = answers.mismatch();
  return mismatch.empty() ? text + kNoServerHint : text + "; " + mismatch;
}

constexpr auto kSettle =
    std::chrono::milliseconds(50);  // from the first server that is found to the first request
constexpr auto kRepeat = std::chrono::milliseconds(200);
constexpr auto kLinger =
    std::chrono::milliseconds(200);  // after the first answer, for another server of the same id

// @param linger  how long to listen after the first answer
// @param ask     called every few milliseconds until then
dds::ServerParameters waitForAnswer(const dds::Participant& participant, std::uint32_t server_id,
                                    std::chrono::milliseconds patience, std::chrono::milliseconds linger,
                                    const Fits& fits, const std::function<void()>& ask) {
  const dds::Reader<dds::ServerParameters> answers(participant);
  Clock::time_point end = Clock::now() + patience;
  std::optional<Clock::time_point> answered;
  Answers found;
  while (Clock::now() <= end && !stopRequested()) {
    if (!answered) ask();  // a request that was answered may be somebody else's to change by now
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    found.take(answers, fits);
    if (std::exchange(found.pending, false)) end = Clock::now() + patience;
    if (found.newest && !answered) answered = Clock::now();
    if (answered && Clock::now() - *answered >= linger) break;
  }
  if (found.newest) return onlyAnswer(found);
  if (stopRequested()) throw ClientError("interrupted while waiting for a server");
  throw ClientError(missing(server_id, participant, answers, patience));
}

}  // namespace

dds::ServerParameters exchangeParameters(const dds::Participant& participant, dds::ParameterRequest request,
                                         std::chrono::milliseconds patience) {
  const auto linger =
      request.session == 0 ? kLinger : std::chrono::milliseconds(0);  // only one run can answer
  if (!participant.mayWrite(dds::TopicTraits<dds::ParameterRequest>::kName)) {
    if (request.fields != 0 || request.model[0] != '\0')
      throw ClientError("the identity " + participant.identity()->name() + " has the role " +
                        std::string(dds::wordOf(participant.identity()->role())) +
                        ", only an operator may change parameters");
    const Fits of_server = [&](const dds::ServerParameters& answer) {  // to whomever
      return answer.server_id == request.server_id &&
             (request.session == 0 || answer.session == request.session);
    };
    return waitForAnswer(participant, request.server_id, patience, linger, of_server, [] {});
  }
  dds::Writer<dds::ParameterRequest> requests(participant);
  request.request_id = firstRequestId();
  Clock::time_point next = Clock::now();
  const auto ask = [&] {
    if (requests.matched() == 0) next = Clock::now() + kSettle;
    if (Clock::now() < next) return;
    (void)requests.write(request);
    next = Clock::now() + kRepeat;
  };
  const Fits to_us = [&](const dds::ServerParameters& answer) {
    return answer.request_id == request.request_id;
  };
  return waitForAnswer(participant, request.server_id, patience, linger, to_us, ask);
}

}  // namespace palpate::client
