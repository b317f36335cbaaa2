// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/contact/contact_solver.h"
#include "core/model/field_evaluation.h"
#include "core/model/meta_model.h"
#include "core/tick/continuity.h"
#include "core/tick/coupling_damper.h"
#include "core/tick/force_limiter.h"
#include "core/tick/live_blend.h"
#include "core/tick/step_config.h"

namespace palpate {

/// What one tool carries from tick to tick.
struct ToolMemory {
  Contact contact;
  Rendering rendering;
  Continuity continuity;
  CouplingDamper damper;
};

/// The sources of a field, kept from one part of a tick to the next and from tick to tick.
class KeptSources {
 public:
  [[nodiscard]] std::span<const FieldSource> all() const noexcept PALPATE_NONBLOCKING {
    return std::span(sources_).first(count_);
  }
  /// @param sources  at most 2 kMaxTools. Real-time: yes.
  void keep(std::span<const FieldSource> sources) noexcept PALPATE_NONBLOCKING {
    std::copy(sources.begin(), sources.end(), sources_.begin());
    count_ = sources.size();
  }
  /// Bit for bit the same. Real-time: yes.
  [[nodiscard]] bool operator==(const KeptSources& other) const noexcept PALPATE_NONBLOCKING {
    const auto a = all(), b = other.all();
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  std::array<FieldSource, 2 * kMaxTools> sources_{};
  std::size_t count_{0};
};

/// All that lives from tick to tick, and all scratch: the loop's only allocation, made before it. One
/// thread's.
class Workspace {
 public:
  /// @throw std::invalid_argument naming the first bad field of config
  Workspace(const MetaModel& model, const StepConfig& config);

  /// Displacement of the surface nodes after the last step, [Ns][3], m.
  [[nodiscard]] std::span<const float> displacement() const noexcept { return displacement_; }
  [[nodiscard]] const StepConfig& config() const noexcept { return config_; }
  /// A tool's live parameters in force after the last step.
  [[nodiscard]] const LiveParameters& live(std::size_t tool = 0) const noexcept { return live_[tool].now(); }

 private:
  friend class Stepper;  // step()'s own

  StepConfig config_;
  std::array<LiveBlend, kMaxTools> live_;        // by tool, like
  std::array<ContactSolver, kMaxTools> solver_;  // for the tips in force
  std::array<double, kMaxTools> tip_radius_;     // m, to be in force once the tool touches nothing
  ForceLimiter limiter_;
  std::array<ToolMemory, kMaxTools> tools_{};
  FieldScratch scratch_;
  KeptSources sources_;      // of this tick's field,
  KeptSources shown_;        // and of the one that displacement_ shows,
  bool shown_known_{false};  // if that is the field of just these
  bool overflowed_{false};   // the last field evaluated was not finite everywhere
  std::vector<float> displacement_;
  std::vector<float> displacement_from_;  // the field shown at the last jump,
  bool blends_from_shown_{false};         // which is still displacement_ itself until the next one is shown,
  double displacement_blend_{0.0};        // and its weight, 1 at the jump, then falling to 0
  double shown_age_{0.0};                 // s since displacement_ was shown last
  bool shaken_{false};                    // a contact came or went at once: kOthersJumped in the next tick
};

}  // namespace palpate
