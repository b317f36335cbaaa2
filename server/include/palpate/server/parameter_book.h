// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "palpate/idl/types.h"
#include "palpate/server/facts.h"

namespace palpate::server {

/// The parameters that may change while the server runs: what is in force, and who may change what. Knows no DDS
/// entity. Threads: one. Real-time: no.
class ParameterBook {
 public:
  /// What is in force at the start, and the limits that stay: the device's stiffness limit for the coupling, and for the
  /// force the device's limit or that of the start, whichever is higher. "custom" has only the engine's own ranges.
  explicit ParameterBook(const Facts& facts);

  /// Takes a request whole or not at all.
  /// @return the answer: accepted, or why not in one sentence with field, number and range; and what is in force now
  [[nodiscard]] dds::ServerParameters decide(const dds::ParameterRequest& request);

  /// The answer to a request that nobody made: what is in force.
  [[nodiscard]] dds::ServerParameters answer() const;

  [[nodiscard]] const LiveParameters& inForce() const noexcept { return live_; }
  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

 private:
  [[nodiscard]] std::string complaintAbout(const dds::ParameterRequest& request,
                                           const LiveParameters& wanted) const;

  std::uint32_t server_id_;
  std::string device_;
  double model_youngs_modulus_;  // Pa
  double stiffness_limit_;       // N/m
  double force_ceiling_;         // N
  LiveParameters live_;
  std::uint64_t revision_{0};
};

}  // namespace palpate::server
