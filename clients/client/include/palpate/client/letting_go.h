// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "palpate/idl/types.h"

namespace palpate::client {

/// Whether a server fades a tool's force because poses stopped: from a stale pose to the end of the ramp after it, not the ramp
/// of a new contact. Threads: one. Real-time: yes.
class LettingGo {
 public:
  /// @param[in] flags  of the answers, in their order  @return whether this one is of a force that fades or comes back
  bool add(std::uint32_t flags) noexcept {
    const bool stale = (flags & dds::flag::kStalePose) != 0;
    const bool ramping = (flags & dds::flag::kRamping) != 0;
    on_ = stale || (on_ && ramping);
    return on_;
  }
  [[nodiscard]] bool on() const noexcept { return on_; }

 private:
  bool on_{false};
};

}  // namespace palpate::client
