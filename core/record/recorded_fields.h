// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/record/recording.h"
#include "core/tick/step.h"

// The fields of what is recorded, each once and in the order of the file: writer, reader and comparison walk these
// lists, so that padding never counts. visit(name, field) gets numbers and std::arrays of numbers.
namespace palpate::record {

// A new field changes a size: add it to its list, and raise the version (kVersion).
static_assert(sizeof(ToolSettings) == 64 && sizeof(StepConfig) == 120 + 4 * 72 && sizeof(ToolInput) == 80 &&
                  sizeof(ToolResult) == 192 && sizeof(StepInput) == 4 * 80 + 32 + 4 * 64 &&
                  sizeof(PoseFacts) == 32,
              "core has other fields than the recording");

template <class Config, class Visit>
void forEachConfigField(Config& config, Visit&& visit) {
  visit("tip_radius", config.tip_radius);
  visit("force_limit", config.force_limit);
  visit("stale_timeout", config.stale_timeout);
  visit("zero_after", config.zero_after);
  visit("ramp_time", config.ramp_time);
  visit("quaternion_tolerance", config.quaternion_tolerance);
  visit("friction", config.friction);
  visit("coupling_stiffness", config.coupling_stiffness);
  visit("rendered_stiffness", config.rendered_stiffness);
  visit("organ_stiffness", config.organ_stiffness);
  visit("coupling_damping", config.coupling_damping);
  visit("force_rate_limit", config.force_rate_limit);
  visit("speed_limit", config.speed_limit);
  visit("youngs_modulus", config.youngs_modulus);
  visit("tools", config.tools);
}

template <class Settings, class Visit>
void forEachSetting(Settings& all, Visit&& visit) {
  for (auto& tool : all) {
    visit("tip_radius", tool.tip_radius);
    for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
      visit(kLiveParameters[i].name, tool.live.*kLiveFields<LiveParameters>[i]);
    visit("rendered_stiffness", tool.rendered_stiffness);
  }
}

template <class Facts, class Visit>
void forEachFact(Facts& facts, Visit&& visit) {
  visit(facts.seq);
  visit(facts.stamp_ns);
  visit(facts.arrival_ns);
  visit(facts.buttons);
}

template <class Result, class Visit>
void forEachResultField(Result& result, Visit&& visit) {
  visit("flags", result.flags);
  visit("state", result.state);
  visit("force", result.force);
  visit("stiffness", result.stiffness);
  visit("anchor", result.anchor);
  visit("proxy", result.proxy);
  visit("displacement", result.displacement);
  visit("domain_radius", result.domain_radius);
  visit("penetration", result.penetration);
}

}  // namespace palpate::record
