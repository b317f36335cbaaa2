// SPDX-License-Identifier: Apache-2.0
#include "core/tick/workspace.h"

namespace palpate {

namespace {

const StepConfig& checked(const StepConfig& config) {
  check(config);
  return config;
}

// One of each tool. @param make  from its settings
template <class Make>
auto ofEach(const StepConfig& config, Make make) {
  const AllToolSettings all = toolSettings(config);
  static_assert(kMaxTools == 4);
  return std::array{make(all[0]), make(all[1]), make(all[2]), make(all[3])};
}

}  // namespace

Workspace::Workspace(const MetaModel& model, const StepConfig& config)
    : config_(checked(config)),
      live_(ofEach(config,
                   [&](const ToolSettings& own) {
                     return LiveBlend(own, {model.attributes().E, config.organ_stiffness});
                   })),
      solver_(ofEach(config, [](const ToolSettings& own) { return ContactSolver(own.tip_radius); })),
      tip_radius_(ofEach(config, [](const ToolSettings& own) { return own.tip_radius; })),
      limiter_(config),
      scratch_(model),
      touches_(model) {}

}  // namespace palpate
