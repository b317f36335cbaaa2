// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "palpate/idl/participant.h"

namespace palpate::dds {

/// Finds endpoints of others on our topics that match none of ours, and says why and whose they are. DDS says neither, and
/// nothing at all of a type with another name. It reads what DDS discovered, its builtin topics.
/// Each endpoint is judged once, `patience` after it was found: until then types may be under comparison.
/// At most kMostAtOnce wait for that; the rest wait in DDS, so a flood of endpoints costs no more per call.
/// Threads: one. Real-time: no. The participant and the endpoints must outlive it.
class EndpointWatch {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMostAtOnce = 64;

  /// @throw DdsError
  explicit EndpointWatch(const Participant& participant,
                         std::chrono::milliseconds patience = std::chrono::seconds(1))
      : EndpointWatch(participant.handle(), patience) {}
  EndpointWatch(dds_entity_t participant, std::chrono::milliseconds patience);

  /// @param endpoint  a Writer or a Reader
  template <class E>
  void add(const E& endpoint) {
    add(endpoint.handle(), E::kWrites);
  }
  void add(dds_entity_t endpoint, bool writes);

  /// @return one line for each endpoint that was judged and does not fit
  [[nodiscard]] std::vector<std::string> poll(Clock::time_point now = Clock::now());

 private:
  struct Ours {
    dds_entity_t handle;
    bool writes;
    std::string topic, type;
  };
  struct Suspect {
    dds_instance_handle_t endpoint;
    bool writes;
    std::string text;
    Clock::time_point found;
  };

  void look(dds_entity_t builtin, bool writes, Clock::time_point now);
  void note(const dds_builtintopic_endpoint_t& other, dds_instance_handle_t endpoint, bool writes,
            Clock::time_point now);
  [[nodiscard]] bool fitsOneOfOurs(dds_instance_handle_t endpoint, bool writes) const;
  [[nodiscard]] std::string owner(dds_instance_handle_t participant) const;

  dds_instance_handle_t own_{0};  // the participant: its endpoints fit, or want nothing of each other
  std::chrono::milliseconds patience_;
  std::vector<Ours> ours_;
  std::vector<Suspect> suspects_;
  Entity writers_, readers_, participants_;  // of the builtin topics
};

}  // namespace palpate::dds
