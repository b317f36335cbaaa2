// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

#include "core/base/max_tools.h"
#include "core/contact/contact_solver.h"
#include "core/contact/coupling.h"
#include "core/model/meta_model.h"
#include "core/tick/continuity.h"
#include "core/tick/step_io.h"
#include "core/tick/workspace.h"

namespace palpate {

/// One step() over one workspace.
class Stepper {
 public:
  Stepper(const MetaModel& model, Workspace& work, const StepInput& input) noexcept PALPATE_NONBLOCKING
      : model_(model),
        work_(work),
        input_(input),
        time_(input),
        shaken_(std::exchange(work.shaken_, false)) {}

  [[nodiscard]] StepStatus run(StepResult& result) noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] std::size_t numberOf(const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING {
    return static_cast<std::size_t>(&memory - work_.tools_.data());
  }
  [[nodiscard]] ContactLaw law(const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING;
  void expect() const noexcept PALPATE_NONBLOCKING;
  void changeLive() noexcept PALPATE_NONBLOCKING;
  void advance(const ToolInput& tool, ToolMemory& memory, ToolResult& out) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool follow(const ToolInput& tool, TipWay way, ToolMemory& memory,
                            ToolResult& out) noexcept PALPATE_NONBLOCKING;
  void render(ToolMemory& memory, bool held, bool jumped, ToolResult& out) noexcept PALPATE_NONBLOCKING;
  void deform(StepResult& result) noexcept PALPATE_NONBLOCKING;
  void showAnchor(const Vec3& u, ToolMemory& memory) const noexcept PALPATE_NONBLOCKING;
  void report(std::size_t tool, ToolResult& out) const noexcept PALPATE_NONBLOCKING;

  const MetaModel& model_;
  Workspace& work_;
  const StepInput& input_;
  const TickTime time_;
  const bool shaken_;   // kOthersJumped
  bool jumped_{false};  // some force has a discontinuity in this tick
};

}  // namespace palpate
