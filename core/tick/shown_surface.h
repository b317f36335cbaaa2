// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/model/field_evaluation.h"
#include "core/model/meta_model.h"
#include "core/tick/surface_state.h"

namespace palpate {

/// The organ's surface as it is shown: evaluates what ticks hand over, at a rate of its own.   docs/design.md, Threads
/// Where a contact jumps, the field blends over like the force, from the field that was shown last: one weight for the
/// whole field, so that a second jump starts from what is shown. Borrows the model; all memory is allocated before the
/// loop. Threads: one.
class ShownSurface {
 public:
  explicit ShownSurface(const MetaModel& model);

  /// Shows what a tick handed over; ticks may be left out, also those in which a jump began.
  /// @return false when it is the field of before. Cost O(n Ns), nothing when nothing changed. Real-time: yes.
  bool show(const SurfaceState& state) noexcept PALPATE_NONBLOCKING;
  /// Nobody looks any more: the next field blends from nothing. Real-time: yes.
  void forget() noexcept PALPATE_NONBLOCKING { in_sight_ = blends_ = false; }

  /// Displacement of the surface nodes, [Ns][3], m; at first zero.
  [[nodiscard]] std::span<const float> displacement() const noexcept { return displacement_; }
  /// The field evaluated last was not finite everywhere; it counts as zero.
  [[nodiscard]] bool overflowed() const noexcept { return overflowed_; }

 private:
  [[nodiscard]] bool evaluate() noexcept PALPATE_NONBLOCKING;

  const MetaModel& model_;
  FieldScratch scratch_;
  FieldSources sources_;             // of displacement_,
  bool pure_{false};                 // in which no other field is mixed
  std::vector<float> displacement_;  // [Ns][3] m
  std::vector<float> from_;          // the field shown before the last jump, [Ns][3] m
  std::uint64_t jumps_{0};
  bool blends_{false};   // from_ is what the last jump blends from
  bool in_sight_{true};  // displacement_ is what a viewer sees; at first the rest surface
  bool overflowed_{false};
};

}  // namespace palpate
