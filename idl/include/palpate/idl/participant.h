// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "palpate/idl/entity.h"
#include "palpate/idl/identity.h"

namespace palpate::dds {

inline constexpr std::uint32_t kMaxDomain = 230;  ///< beyond it the UDP port numbers run out

/// A process's membership in a DDS domain. The environment's CYCLONEDDS_URI decides about interfaces.
class Participant {
 public:
  /// @param[in] domain    0 .. kMaxDomain
  /// @param[in] identity  who it is where topics are signed and encrypted; it meets only participants with an identity of the
  ///                      same authority. Nothing: neither is, and it meets only others without
  /// @throw DdsError with the reason: domain out of range, Cyclone's configuration or the identity refused (its own log
  /// line on
  ///        standard error names the element)
  /// Real-time: no.
  explicit Participant(std::uint32_t domain, std::optional<Identity> identity = {});

  [[nodiscard]] dds_entity_t handle() const noexcept { return entity_.handle(); }
  [[nodiscard]] std::uint32_t domain() const noexcept { return domain_; }
  [[nodiscard]] const std::optional<Identity>& identity() const noexcept { return identity_; }
  /// Whether its role lets it write this topic. Without an identity: all.
  [[nodiscard]] bool mayWrite(std::string_view topic) const {
    return !identity_ || dds::mayWrite(identity_->role(), topic);
  }
  /// Its name on the wire, 32 hexadecimal digits. Real-time: no.
  [[nodiscard]] std::string guid() const;

 private:
  std::uint32_t domain_;
  std::optional<Identity> identity_;
  Entity entity_;
};

}  // namespace palpate::dds
