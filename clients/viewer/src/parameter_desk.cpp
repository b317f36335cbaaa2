// SPDX-License-Identifier: Apache-2.0
#include "parameter_desk.h"

#include <random>

namespace palpate::viewer {
namespace {

std::uint64_t freshId() {
  std::random_device random;
  return (static_cast<std::uint64_t>(random()) << 32 | random()) >> 1 |
         1U;  // rises by one per request, never 0
}

}  // namespace

SetParameters merged(const SetParameters& earlier, const SetParameters& later) {
  SetParameters result = earlier;
  result.request = later.request;
  const auto take = [](std::optional<double>& into, const std::optional<double>& from) {
    if (from) into = from;
  };
  take(result.youngs_factor, later.youngs_factor);
  take(result.friction, later.friction);
  take(result.coupling_stiffness, later.coupling_stiffness);
  take(result.coupling_damping, later.coupling_damping);
  take(result.force_limit, later.force_limit);
  take(result.force_rate_limit, later.force_rate_limit);
  return result;
}

dds::ParameterRequest requestOf(const SetParameters& wanted, double model_youngs_modulus) {
  dds::ParameterRequest request{};
  const auto set = [&](std::uint32_t bit, const std::optional<double>& from, double& into,
                       double unit = 1.0) {
    if (!from) return;
    request.fields |= bit;
    into = *from * unit;
  };
  set(dds::parameter::kYoungsModulus, wanted.youngs_factor, request.youngs_modulus, model_youngs_modulus);
  set(dds::parameter::kFriction, wanted.friction, request.friction);
  set(dds::parameter::kCouplingStiffness, wanted.coupling_stiffness, request.coupling_stiffness);
  set(dds::parameter::kCouplingDamping, wanted.coupling_damping, request.coupling_damping);
  set(dds::parameter::kForceLimit, wanted.force_limit, request.force_limit);
  set(dds::parameter::kForceRateLimit, wanted.force_rate_limit, request.force_rate_limit);
  return request;
}

ParameterDesk::ParameterDesk(const dds::Participant& participant)
    : writer_(participant), next_id_(freshId()) {}

void ParameterDesk::set(std::uint64_t page_id, const SetParameters& wanted) {
  Wish& wish = wishes_[page_id];
  wish.waiting = wish.waiting ? merged(*wish.waiting, wanted) : wanted;
}

void ParameterDesk::saw(const dds::ServerParameters& answer) {
  for (auto& [page_id, wish] : wishes_) {
    if (!wish.asked || wish.request.request_id != answer.request_id ||
        wish.request.server_id != answer.server_id)
      continue;
    answers_.push_back({page_id, wish.asked->request, answer.accepted, answer.message});
    wish.asked.reset();
  }
}

bool ParameterDesk::startNext(std::uint64_t page_id, Wish& wish,
                              const std::optional<dds::ServerParameters>& server, std::int64_t now_ns) {
  if (!server) {
    answers_.push_back({page_id, wish.waiting->request, false, "no server has said its parameters yet"});
    wish.waiting.reset();
    return false;
  }
  wish.asked = std::exchange(wish.waiting, std::nullopt);
  wish.request = requestOf(*wish.asked, server->model_youngs_modulus);
  wish.request.server_id = server->server_id;
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
    if (writer_.matched() > 0 && writer_.write(wish.request)) wish.sent_ns = now_ns;
  }
}

}  // namespace palpate::viewer
