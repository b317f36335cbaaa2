// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/tick/shown_surface.h"
#include "core/tick/step.h"
#include "palpate/testing/synthetic_model.h"

namespace palpate::testing {

inline MetaModel loadSynthetic(const SyntheticOptions& options = {}) {
  const TemporaryFile file("driver.h5");
  writeSyntheticModel(file.path(), options);
  return MetaModel::load(file.path());
}

/// Plays poses of one tool, a millisecond each, and remembers the last answer.
class Driver {
 public:
  explicit Driver(const MetaModel& model, const StepConfig& config = {})
      : model_(model), work_(model, config), surface_(model) {}

  const ToolResult& at(const Vec3& c, std::int64_t age_ns = 0) {
    input_.tools[0].present = 1;
    input_.tools[0].position = {c.x(), c.y(), c.z()};
    input_.tools[0].age_ns = age_ns;
    return tick();
  }
  const ToolResult& tick() {
    status_ = step(model_, work_, input_, result_);
    if (shows_) (void)surface_.show(work_.surface());
    input_.field_overflowed = surface_.overflowed() ? 1 : 0;
    return result_.tools[0];
  }
  /// Stays at c until what follows a jump has faded.
  const ToolResult& settle(const Vec3& c) {
    for (int i = 0; i < 40; ++i) at(c);
    return result_.tools[0];
  }
  StepInput& input() { return input_; }
  const StepResult& result() const { return result_; }
  const Workspace& work() const { return work_; }
  /// The surface as the last tick that was shown left it, [Ns][3] m.
  std::span<const float> field() const { return surface_.displacement(); }
  ShownSurface& surface() { return surface_; }
  /// Whether ticks are shown.
  void show(bool shows) { shows_ = shows; }
  StepStatus status() const { return status_; }

 private:
  const MetaModel& model_;
  Workspace work_;
  ShownSurface surface_;
  bool shows_{true};
  StepInput input_;
  StepResult result_;
  StepStatus status_{StepStatus::kOk};
};

template <typename Array>
Vec3 vec(const Array& a) {
  return {a[0], a[1], a[2]};
}

}  // namespace palpate::testing
