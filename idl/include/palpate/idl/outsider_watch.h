// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <set>
#include <string>
#include <vector>

#include "palpate/idl/participant.h"

namespace palpate::dds {

/// Finds participants of others that a participant with an identity did not let in, or that did not let it in: DDS saw them
/// and heard of no endpoint of theirs. DDS says so only where it finds a certificate or permissions wrong itself.
/// Each is judged once, `patience` after it was found, since a handshake comes before endpoints. At most kMostAtOnce wait for
/// that; the rest wait in DDS. Threads: one. Real-time: no. The participant must outlive it.
class OutsiderWatch {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMostAtOnce = 64;

  /// @throw DdsError
  explicit OutsiderWatch(const Participant& participant,
                         std::chrono::milliseconds patience = std::chrono::seconds(3));

  /// @return one line for each that was judged and is not in
  [[nodiscard]] std::vector<std::string> poll(Clock::time_point now = Clock::now());

 private:
  struct Found {
    dds_instance_handle_t participant;
    std::string text;
    Clock::time_point found;
  };

  void lookForEndpoints(dds_entity_t builtin);
  void lookForParticipants(Clock::time_point now);

  dds_instance_handle_t own_{0};
  std::chrono::milliseconds patience_;
  std::vector<Found> found_;
  std::set<dds_instance_handle_t> in_;       // participants with endpoints: authenticated ones
  Entity participants_, writers_, readers_;  // of the builtin topics
};

}  // namespace palpate::dds
