// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/types.h"

namespace palpate {

/// What one tool's contact may cost in one tick, in evaluations of the organ's answer. All loops of a tick, one inside
/// the other, spend from the same budget; one that finds it spent ends with the best that it has
/// (docs/decisions/budget.md). A count and no clock, so that a replay gives the same bits. Real-time: yes.
class Budget {
 public:
  static constexpr int kEvaluations = 600;
  /// Of an anchor at a new place, beside the evaluations there: the way to it, its frame, its mixed coefficients.
  static constexpr int kPlace = 8;

  explicit constexpr Budget(int evaluations = kEvaluations) noexcept
      : all_(evaluations), left_(evaluations) {}
  /// No bound, for questions outside of a tick.
  [[nodiscard]] static constexpr Budget endless() noexcept { return Budget(1 << 30); }

  void spend(int evaluations) noexcept PALPATE_NONBLOCKING { left_ -= evaluations; }
  /// A loop asks before each step that it would still take.
  /// @return false where nothing is left; the answer of this tick is cut short then
  [[nodiscard]] bool allows() noexcept PALPATE_NONBLOCKING {
    cut_ = cut_ || left_ <= 0;
    return left_ > 0;
  }
  /// Whether a loop was refused a step.
  [[nodiscard]] bool cut() const noexcept PALPATE_NONBLOCKING { return cut_; }
  /// The last step may go beyond the budget.
  [[nodiscard]] int used() const noexcept PALPATE_NONBLOCKING { return all_ - left_; }

 private:
  int all_;
  int left_;
  bool cut_{false};
};

}  // namespace palpate
