// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "palpate/idl/participant.h"

namespace palpate::dds {

/// Finds participants of others that a participant with an identity did not let in, or that did not let it in: DDS saw them
/// and heard of no endpoint of theirs. DDS says so only where it finds a certificate or permissions wrong itself, and of nobody
/// that he was authenticated. So one without endpoints, or whose handshake takes longer than `patience`, looks the same; the line
/// says that, and if endpoints come after it, another line does.
/// Each is judged once, `patience` after it was found. At most kMostAtOnce wait for that; the rest wait in DDS.
/// Threads: one. Real-time: no. The participant must outlive it.
class OutsiderWatch {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMostAtOnce = 64;

  /// @throw DdsError
  explicit OutsiderWatch(const Participant& participant,
                         std::chrono::milliseconds patience = std::chrono::seconds(3));

  /// @return one line for each that was judged and is not in, and for each of these that is in after all
  [[nodiscard]] std::vector<std::string> poll(Clock::time_point now = Clock::now());

 private:
  struct Found {
    dds_instance_handle_t participant;
    std::string name, complaint;
    Clock::time_point found;
  };

  void lookForEndpoints(dds_entity_t builtin, std::vector<std::string>& lines);
  void lookForParticipants(Clock::time_point now);

  dds_instance_handle_t own_{0};
  std::chrono::milliseconds patience_;
  std::vector<Found> found_;
  std::set<dds_instance_handle_t> in_;                // participants with endpoints: authenticated ones
  std::map<dds_instance_handle_t, std::string> out_;  // those that were told, by name
  Entity participants_, writers_, readers_;           // of the builtin topics
};

}  // namespace palpate::dds
