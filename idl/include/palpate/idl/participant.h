// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "palpate/idl/entity.h"

namespace palpate::dds {

inline constexpr std::uint32_t kMaxDomain = 230;  ///< beyond it the UDP port numbers run out

/// A process's membership in a DDS domain. The environment's CYCLONEDDS_URI decides about interfaces.
class Participant {
 public:
  /// @param[in] domain  0 .. kMaxDomain
  /// @throw DdsError with the reason: domain out of range, or Cyclone's configuration refused (its own log
  /// line on
  ///        standard error names the element)
  /// Real-time: no.
  explicit Participant(std::uint32_t domain);

  [[nodiscard]] dds_entity_t handle() const noexcept { return entity_.handle(); }
  [[nodiscard]] std::uint32_t domain() const noexcept { return domain_; }
  /// Its name on the wire, 32 hexadecimal digits. Real-time: no.
  [[nodiscard]] std::string guid() const;

 private:
  std::uint32_t domain_;
  Entity entity_;
};

}  // namespace palpate::dds
