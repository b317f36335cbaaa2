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
  /// Starts from the values of the start, and keeps ceilings. Coupling stiffness: what the device renders stably. Force
  /// limit: the start's or the device's, the larger. Rate limit: the start's. A "custom" device has the start's values as
  /// ceilings of all three.
  explicit ParameterBook(const Facts& facts);

  /// Takes a request whole or not at all.
  /// @return the answer: accepted, or why not in one sentence with field, number and range; and what is in force now
  [[nodiscard]] dds::ServerParameters decide(const dds::ParameterRequest& request);

  /// The values in force, as an answer without a request.
  [[nodiscard]] dds::ServerParameters answer() const;

  /// What is in force, as text: "youngs_modulus 160000 Pa (the model's), friction 0.3, ...".
  [[nodiscard]] std::string describe() const;

  [[nodiscard]] const LiveParameters& inForce() const noexcept { return live_; }
  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

 private:
  [[nodiscard]] std::string complaintAbout(const dds::ParameterRequest& request,
                                           const LiveParameters& wanted) const;

  std::uint32_t server_id_;
  std::string device_;
  double model_youngs_modulus_;  // Pa
  LiveParameters most_;          // stiffness, limits of force and of its rate: never above
  LiveParameters live_;
  std::uint64_t revision_{0};
};

}  // namespace palpate::server
