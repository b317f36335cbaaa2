// SPDX-License-Identifier: Apache-2.0
#include "exchange.h"

#include <array>
#include <optional>
#include <string>
#include <thread>

#include "palpate/client/error.h"
#include "palpate/client/request_id.h"
#include "palpate/client/stop_signal.h"
#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"

namespace palpate::parameters {
namespace {

using Clock = std::chrono::steady_clock;

std::optional<dds::ServerParameters> answerTo(std::uint64_t request_id,
                                              const dds::Reader<dds::ServerParameters>& answers) {
  std::array<dds::ServerParameters, dds::kMaxTake> samples;
  const std::size_t count = answers.take(samples);
  for (std::size_t i = 0; i < count; ++i)
    if (samples[i].request_id == request_id) return samples[i];
  return std::nullopt;
}

std::string missing(std::uint32_t server_id, const dds::Participant& participant,
                    const dds::Reader<dds::ServerParameters>& answers) {
  std::string text = "no server " + std::to_string(server_id) + " answered on DDS domain " +
                     std::to_string(participant.domain());
  if (const std::string mismatch = answers.mismatch(); !mismatch.empty()) text += "; " + mismatch;
  return text;
}

}  // namespace

dds::ServerParameters exchange(const dds::Participant& participant, dds::ParameterRequest request,
                               std::chrono::milliseconds patience) {
  dds::Writer<dds::ParameterRequest> requests(participant);
  const dds::Reader<dds::ServerParameters> answers(participant);
  request.request_id = client::firstRequestId();
  const Clock::time_point end = Clock::now() + patience;
  Clock::time_point next = Clock::now();
  while (Clock::now() <= end && !client::stopRequested()) {
    if (Clock::now() >= next && requests.matched() > 0) {
      (void)requests.write(request);
      next = Clock::now() + std::chrono::milliseconds(200);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (const auto answer = answerTo(request.request_id, answers)) return *answer;
  }
  throw client::ClientError(missing(request.server_id, participant, answers));
}

}  // namespace palpate::parameters
