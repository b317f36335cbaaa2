// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/data/region_surfaces.h"
#include "core/devices/path/pose_follower.h"
#include "core/model/meta_model.h"
#include "core/tick/shown_surface.h"
#include "core/tick/step.h"

namespace palpate {

/// A model that is felt.
struct Organ {
  static constexpr double kHandSpeed = 0.6;  ///< m/s

  MetaModel model;
  Workspace work;
  ShownSurface shown;
  FieldScratch scratch;
  std::vector<float> field;
  StepInput input{};
  StepResult result{};
  AllToolSettings settings;
  double speed_limit;                            ///< m/s, of the tool that the page drives
  std::optional<device::PoseFollower> follower;  ///< of the tool that the page drives
  std::vector<std::uint8_t> accessible, clamped;
  std::vector<RegionSurface> regions;

  Organ(MetaModel loaded, const StepConfig& config)
      : model(std::move(loaded)),
        work(model, config),
        shown(model),
        scratch(model),
        field(3 * model.view().surfaceNodes(), 0.0F),
        settings(toolSettings(config)),
        speed_limit(std::min(kHandSpeed, 0.5 * config.speed_limit)),
        accessible(model.accessibleNodes()),
        clamped(model.clampedNodes()),
        regions(regionSurfaces(model.view())) {
    for (ToolSettings& tool : settings)
      if (tool.live.youngs_modulus == 0.0) tool.live.youngs_modulus = model.attributes().E;
  }
};

/// The one that the page has, or null.
extern std::unique_ptr<Organ> organ;

}  // namespace palpate
