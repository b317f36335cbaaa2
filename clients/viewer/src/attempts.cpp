// SPDX-License-Identifier: Apache-2.0
#include "attempts.h"

#include <arpa/inet.h>

namespace palpate::viewer {
namespace {

constexpr double kAtOnce = 10.0;
constexpr double kPerSecond = 10.0 / 60.0;
constexpr std::int64_t kForgottenNs = 60'000'000'000;  // all of kAtOnce are back
constexpr std::size_t kMostPeers = 256;

// What one sender cannot change at will: an IPv4 address, the upper half of an IPv6 address.
std::string senderOf(std::string_view peer) {
  const std::string text(peer);
  in6_addr bits{};
  if (inet_pton(AF_INET6, text.c_str(), &bits) != 1 || IN6_IS_ADDR_V4MAPPED(&bits)) return text;
  return {reinterpret_cast<const char*>(bits.s6_addr), 8};
}

}  // namespace

Attempts::Count Attempts::fresh(std::int64_t now_ns) {
  return {rt::TokenBucket(kPerSecond, kAtOnce), now_ns};
}

bool Attempts::take(std::string_view peer, std::int64_t now_ns) {
  const std::string sender = senderOf(peer);
  if (!peers_.contains(sender) && peers_.size() >= kMostPeers)
    std::erase_if(peers_, [&](const auto& entry) { return now_ns - entry.second.last_ns > kForgottenNs; });
  const bool room = peers_.contains(sender) || peers_.size() < kMostPeers;
  Count& count = room ? peers_.try_emplace(sender, fresh(now_ns)).first->second : others_;
  count.last_ns = now_ns;
  return count.left.take(now_ns);
}

void Attempts::forgive(std::string_view peer) {
  peers_.erase(senderOf(peer));
}

}  // namespace palpate::viewer
