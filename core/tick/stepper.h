// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/tick/step_io.h"
#include "core/tick/tool_surface.h"
#include "core/tick/workspace.h"

namespace palpate {

/// One step() over one workspace.
class Stepper {
 public:
  Stepper(const MetaModel& model, Workspace& work, const StepInput& input) noexcept PALPATE_NONBLOCKING
      : model_(model),
        work_(work),
        input_(input),
        dt_(std::clamp(1e-9 * double(input.dt_ns), 0.0, 0.1)),
        period_(input.period_ns > 0 ? std::min(1e-9 * double(input.period_ns), 0.1) : 1e-3),
        ramp_dt_(std::min(dt_, 2.0 * period_)),
        disturbed_(1e-9 * double(input.dt_ns) > std::max(10.0 * period_, kStall)),
        shaken_(std::exchange(work.shaken_, false)) {}

  [[nodiscard]] StepStatus run(StepResult& result) noexcept PALPATE_NONBLOCKING;
  static bool showSurface(const MetaModel& model, Workspace& work) noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] std::uint32_t judge(const ToolInput& tool) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool leapt(const ToolInput& tool,
                           const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool interrupted(const ToolInput& tool,
                                 const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] double between(const ToolInput& tool,
                               const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] std::size_t numberOf(const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING {
    return static_cast<std::size_t>(&memory - work_.tools_.data());
  }
  [[nodiscard]] ContactLaw law(const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING;
  void changeLive() noexcept PALPATE_NONBLOCKING;
  void advance(const ToolInput& tool, ToolMemory& memory, ToolResult& out) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool follow(const ToolInput& tool, ToolMemory& memory,
                            ToolResult& out) noexcept PALPATE_NONBLOCKING;
  void grow(const ToolInput& tool, ToolMemory& memory) const noexcept PALPATE_NONBLOCKING;
  void render(ToolMemory& memory, bool held, bool jumped, ToolResult& out) noexcept PALPATE_NONBLOCKING;
  void deform(StepResult& result) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool showAnchors(const ToolSurface& surface) noexcept PALPATE_NONBLOCKING;
  void report(std::size_t tool, ToolResult& out) const noexcept PALPATE_NONBLOCKING;

  static constexpr double kStall = 0.01;  // s; in a faster loop, a hand does not notice ten periods

  const MetaModel& model_;
  Workspace& work_;
  const StepInput& input_;
  double dt_;
  double period_;       // s; the caller's, or 1 ms
  double ramp_dt_;      // s that ramps advance: without the time that the loop stood still
  bool disturbed_;      // the loop stood still: no force follows from the last
  bool jumped_{false};  // a contact jumped in this tick
  bool shaken_;         // a contact jumped in the last tick: what other tools feel of it jumps now
  std::array<Vec3, kMaxTools> shown_;  // u at each tool's anchor, m
};

}  // namespace palpate
