// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/server_hold.h"

#include <array>
#include <cstdio>

namespace palpate::client {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

}  // namespace

std::string nameOf(const ServerRun& run) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "server %u, session %016llx", run.server_id,
                static_cast<unsigned long long>(run.session));
  return text.data();
}

bool ServerHold::gone(std::int64_t now_ns) const noexcept {
  const std::int64_t heard_ns = heard_ns_.load(kRelaxed);
  const std::int64_t patience_ns = farewell_.load(kRelaxed) ? kFarewellNs : silence_ns_;
  return heard_ns != 0 && now_ns - heard_ns > patience_ns;
}

bool ServerHold::takes(const ServerRun& from, dds::WriterId writer, std::int64_t now_ns, bool eligible,
                       bool farewell) noexcept {
  const bool held = held_.load(kRelaxed);
  const bool same = held && from == ServerRun{id_.load(kRelaxed), session_.load(kRelaxed)} &&
                    (writer_ == 0 || writer == writer_);
  const std::uint32_t wanted_id = wanted_.load(kRelaxed);
  const bool wanted = wanted_id == dds::kServerAny || wanted_id == from.server_id;
  const bool next = !same && eligible && wanted && (!held || gone(now_ns));
  if (!same && !next) {
    left_out_id_.store(from.server_id, kRelaxed);
    left_out_session_.store(from.session, kRelaxed);
    left_out_.fetch_add(1, kRelaxed);
    return false;
  }
  if (next) {
    id_.store(from.server_id, kRelaxed);
    session_.store(from.session, kRelaxed);
    held_.store(true, kRelaxed);
  }
  if (next || changes_.load(kRelaxed) == 0) changes_.fetch_add(1, kRelaxed);
  writer_ = writer;
  farewell_.store(farewell, kRelaxed);
  heard_ns_.store(now_ns, kRelaxed);
  return true;
}

std::uint32_t ServerHold::address(std::int64_t now_ns) noexcept {
  if (!held_.load(kRelaxed)) return wanted_.load(kRelaxed);
  std::int64_t never = 0;
  (void)heard_ns_.compare_exchange_strong(never, now_ns, kRelaxed);
  return gone(now_ns) ? wanted_.load(kRelaxed) : id_.load(kRelaxed);
}

ServerRun ServerHold::held() const noexcept {
  if (!held_.load(kRelaxed)) return {};
  return {id_.load(kRelaxed), session_.load(kRelaxed)};
}

LeftOut ServerHold::leftOut() const noexcept {
  return {left_out_.load(kRelaxed), {left_out_id_.load(kRelaxed), left_out_session_.load(kRelaxed)}};
}

}  // namespace palpate::client
