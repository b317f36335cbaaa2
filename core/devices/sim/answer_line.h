// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/devices/sim/delays.h"

namespace palpate::device {

/// The answers to the poses of a device's last steps, kept by the step whose pose they name. So each step takes the answer that its
/// delay asks for, however late or early others came. A step may send its pose again, or none. Real-time: yes. Threads: one.
template <class Answer>
class AnswerLine {
 public:
  /// The pose of a step goes out. @param[in] step, seq  rise from call to call
  void sent(std::size_t step, std::uint64_t seq) noexcept {
    slots_[count_++ % slots_.size()] = {step, seq, false, {}};
  }

  /// @param[in] pose_seq  of the pose that is answered, or of one that was sent again in its step. The first answer to a step
  /// counts; one to a step that is forgotten does not
  /// @param[in] instead  this one takes the place of the one before: that was of a server that blended
  void add(std::uint64_t pose_seq, const Answer& answer, bool instead = false) noexcept {
    for (std::size_t back = 1; back <= kept(); ++back) {
      Slot& slot = newest(back);
      if (slot.first_seq > pose_seq) continue;
      if (!slot.answered || instead) slot.answer = answer;
      slot.answered = true;
      return;
    }
  }

  /// @return whether nothing better will come for `step`: its pose, or one that was sent later, is answered. Where it sent none,
  /// the one before counts
  [[nodiscard]] bool has(std::size_t step) const noexcept {
    for (std::size_t back = 1; back <= kept(); ++back) {
      if (newest(back).answered) return true;
      if (newest(back).step <= step) return false;
    }
    return true;
  }

  /// @return the answer to the pose of `step`; where it was superseded or none was sent, the newest to a pose before it; nullptr:
  /// none is kept
  [[nodiscard]] const Answer* at(std::size_t step) const noexcept {
    for (std::size_t back = 1; back <= kept(); ++back)
      if (newest(back).answered && newest(back).step <= step) return &newest(back).answer;
    return nullptr;
  }

 private:
  struct Slot {
    std::size_t step;
    std::uint64_t first_seq;
    bool answered;
    Answer answer;
  };

  [[nodiscard]] std::size_t kept() const noexcept { return std::min(count_, slots_.size()); }
  [[nodiscard]] Slot& newest(std::size_t back) noexcept { return slots_[(count_ - back) % slots_.size()]; }
  [[nodiscard]] const Slot& newest(std::size_t back) const noexcept {
    return slots_[(count_ - back) % slots_.size()];
  }

  std::array<Slot, 2 * Delays::kStall> slots_{};
  std::size_t count_{0};
};

}  // namespace palpate::device
