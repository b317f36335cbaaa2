// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model/meta_model.h"
#include "core/tick/step.h"
#include "core/tick/step_config.h"
#include "core/tick/step_io.h"
#include "core/tick/workspace.h"

namespace palpate::feel {

/// Plays tip positions of one tool through step(), one per millisecond, without threads.
class Player {
 public:
  Player(const MetaModel& model, const StepConfig& config) : model_(model), work_(model, config) {}

  /// One tick with the tip's centre at c, m.
  const ToolResult& at(const Vec3& c);
  /// One tick without a new pose.
  const ToolResult& again();
  [[nodiscard]] const Workspace& work() const noexcept { return work_; }

 private:
  const MetaModel& model_;
  Workspace work_;
  StepInput input_;
  StepResult result_;
};

/// Force on the tool, N.
[[nodiscard]] Vec3 forceOf(const ToolResult& result);

/// Configuration of a step with the contact alone: no limiter, ramps, speed limit or coupling.
[[nodiscard]] StepConfig bareContact(double friction);

}  // namespace palpate::feel
