// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/workspace.h"

namespace palpate {

namespace {

const StepConfig& checked(const StepConfig& config) {
  check(config);
  return config;
}

}  // namespace

Workspace::Workspace(const MetaModel& model, const StepConfig& config)
    : config_(checked(config)),
      live_(liveParameters(config), model.attributes().E),
      solver_(config.tip_radius),
      limiter_(config),
      scratch_(model),
      displacement_(3 * static_cast<std::size_t>(model.surface().nodes())),
      displacement_from_(displacement_.size()) {}

}  // namespace palpate
