// SPDX-License-Identifier: Apache-2.0
#include "parameter_desk.h"

#include "palpate/client/request_id.h"

namespace palpate::viewer {

SetParameters merged(const SetParameters& earlier, const SetParameters& later) {
  SetParameters result = earlier;
  result.request = later.request;
  for (const auto field : kLiveFields<SetParameters>)
    if (later.*field) result.*field = later.*field;
  return result;
}

dds::ParameterRequest requestOf(const SetParameters& wanted, double model_youngs_modulus) {
  dds::ParameterRequest request{};
  request.tool_id = dds::kAllTools;
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const std::optional<double>& value = wanted.*kLiveFields<SetParameters>[i];
    if (!value) continue;
    request.fields |= kLiveParameters[i].bit;
    request.*kLiveFields<dds::ParameterRequest>[i] = *value;
  }
  if (wanted.youngs_modulus) request.youngs_modulus *= model_youngs_modulus;
  return request;
}

ParameterDesk::ParameterDesk(const dds::Participant& participant) : next_id_(client::firstRequestId()) {
  if (participant.mayWrite(dds::TopicTraits<dds::ParameterRequest>::kName)) writer_.emplace(participant);
}

void ParameterDesk::set(std::uint64_t page_id, const SetParameters& wanted) {
  Wish& wish = wishes_[page_id];
  wish.waiting = wish.waiting ? merged(*wish.waiting, wanted) : wanted;
}

void ParameterDesk::saw(const dds::ServerParameters& answer) {
  for (auto& [page_id, wish] : wishes_) {
    if (!wish.asked || wish.request.request_id != answer.request_id || wish.request.session != answer.session)
      continue;
    answers_.push_back({page_id, wish.asked->request, answer.accepted, answer.message});
    wish.asked.reset();
  }
}

bool ParameterDesk::startNext(std::uint64_t page_id, Wish& wish,
                              const std::optional<dds::ServerParameters>& server, std::int64_t now_ns) {
  if (!writer_) {
    answers_.push_back({page_id, wish.waiting->request, false, "this page may not change parameters"});
    wish.waiting.reset();
    return false;
  }
  if (!server) {
    answers_.push_back({page_id, wish.waiting->request, false, "no server has said its parameters yet"});
    wish.waiting.reset();
    return false;
  }
  wish.asked = std::exchange(wish.waiting, std::nullopt);
  wish.request = requestOf(*wish.asked, server->model_youngs_modulus);
  wish.request.server_id = server->server_id;
  wish.request.session = server->session;
  wish.request.request_id = next_id_++;
  wish.since_ns = now_ns;
  wish.sent_ns = 0;
  return true;
}

void ParameterDesk::tend(const std::optional<dds::ServerParameters>& server, std::int64_t now_ns) {
  for (auto& [page_id, wish] : wishes_) {
    if (wish.asked && now_ns - wish.since_ns > kPatienceNs) {
      answers_.push_back({page_id, wish.asked->request, false, "the server did not answer within 3 s"});
      wish.asked.reset();
    }
    if (!wish.asked && wish.waiting && !startNext(page_id, wish, server, now_ns)) continue;
    if (!wish.asked || now_ns - wish.sent_ns < kRepeatNs) continue;
    if (writer_->matched() > 0 && writer_->write(wish.request)) wish.sent_ns = now_ns;
  }
}

}  // namespace palpate::viewer
