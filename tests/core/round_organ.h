// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "driver.h"

namespace palpate::testing {

/// The synthetic organ: a ball of 50 mm.
inline const MetaModel& roundOrgan() {
  static const MetaModel model = loadSynthetic();
  return model;
}

/// Tip centre `depth` deep, m, over the round organ at an angle from the top, rad.
inline Vec3 over(double angle, double depth, double azimuth = 0.3) {
  const double organ = 0.05, tip = StepConfig{}.tip_radius;
  return (organ + tip - depth) *
         Vec3(std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle));
}

/// n at the anchor; of a free tool at the nearest point.
inline Vec3 normalAt(const MetaModel& model, const ToolResult& r) {
  const ContactSurface& surface = model.contactSurface();
  return surface.mesh().normal(surface.fine(model.surface().closestPoint(vec(r.anchor)).s));
}

}  // namespace palpate::testing
