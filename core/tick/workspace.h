// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/contact/contact_solver.h"
#include "core/model/field_evaluation.h"
#include "core/model/meta_model.h"
#include "core/model/touch_field.h"
#include "core/tick/continuity.h"
#include "core/tick/coupling_damper.h"
#include "core/tick/force_limiter.h"
#include "core/tick/live_blend.h"
#include "core/tick/step_config.h"
#include "core/tick/surface_state.h"

namespace palpate {

/// Where a tool's proxy was reported, and what it blends over from.
struct ShownAnchor {
  Vec3 anchor = Vec3::Zero();  ///< X(s), m
  Vec3 u = Vec3::Zero();       ///< its displacement as reported, m
  Vec3 from = Vec3::Zero();    ///< of that the part that the last jump began with, m
};

/// What one tool carries from tick to tick.
struct ToolMemory {
  Contact contact;
  Rendering rendering;
  Continuity continuity;
  CouplingDamper damper;
  ShownAnchor shown;
};

/// All that lives from tick to tick, and all scratch: the loop's only allocation, made before it. One
/// thread's.
class Workspace {
 public:
  /// @throw std::invalid_argument naming the first bad field of config
  Workspace(const MetaModel& model, const StepConfig& config);

  /// What the surface is made of after the last step: for ShownSurface.
  [[nodiscard]] const SurfaceState& surface() const noexcept PALPATE_NONBLOCKING { return surface_; }
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
  Touches touches_;
  SurfaceState surface_;
  bool shaken_{false};  // a contact came or went at once: kOthersJumped in the next tick
};

}  // namespace palpate
