// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "driver.h"

namespace palpate::testing {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Nothing but the contact: no limiter, ramps or speed limit. @param coupling  K_vc, N/m
inline StepConfig bare(double friction, double coupling = kInfinity) {
  StepConfig config;
  config.friction = friction;
  config.coupling_stiffness = coupling;
  config.force_limit = config.speed_limit = kInfinity;
  config.ramp_time = 0.0;
  return config;
}

/// The synthetic organ: a ball of 50 mm.
inline const MetaModel& roundOrgan() {
  static const MetaModel model = loadSynthetic();
  return model;
}

/// K at a contact position, N/m.
inline Mat3 stiffnessOf(const modelfile::ModelData& data, std::size_t position) {
  const double* const row = data.contact_stiffness.data() + kStiffnessNumbers * position;
  Mat3 K;
  K << row[0], row[4], row[8], row[4], row[12], row[16], row[8], row[16], row[20];
  return K;
}

/// Fields of an organ that goes along as a whole, by 0.8 of what a tool does to its patch.
inline void goesAlong(modelfile::ModelData& data) {
  constexpr double kShared = 0.8;
  constexpr std::size_t kModes = 3;
  const SyntheticOptions options;
  const std::size_t nodes = data.surface_positions.size() / 3, positions = data.contact_node.size();
  const std::size_t C = data.modes_Y.size() / positions / static_cast<std::size_t>(options.modes);
  data.modes_X.assign(kModes * 3 * nodes, 0.0F);
  data.modes_Y.assign(positions * C * kModes, 0.0F);
  data.green_Y.assign(positions * 3 * kModes, 0.0F);
  for (std::size_t axis = 0; axis < kModes; ++axis)
    for (std::size_t node = 0; node < nodes; ++node) data.modes_X[axis * 3 * nodes + 3 * node + axis] = 1.0F;
  for (std::size_t m = 0; m < positions; ++m) {
    const Mat3 share = kShared * stiffnessOf(data, m).inverse();
    for (std::size_t load = 0; load < 3; ++load)
      for (std::size_t axis = 0; axis < kModes; ++axis)
        data.green_Y[(3 * m + load) * kModes + axis] =
            static_cast<float>(share(Eigen::Index(axis), Eigen::Index(load)));
  }
  std::fill(data.near_field.begin(), data.near_field.end(), 0.0F);
  std::fill(data.green_near.begin(), data.green_near.end(), 0.0F);
}

/// Tip centre `depth` deep, m, over the round organ at an angle from the top, rad.
inline Vec3 over(double angle, double depth, double azimuth = 0.3) {
  const double organ = 0.05, tip = StepConfig{}.tip_radius;
  return (organ + tip - depth) *
         Vec3(std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle));
}

/// Tip centre `depth` deep, m, over the highest point of the round organ, and drawn aside.
inline Vec3 above(double depth, double aside = 0.0) {
  const Vec3 top = roundOrgan().surface().closestPoint(Vec3(0.0, 0.0, 1.0)).position;
  return top + Vec3(aside, 0.0, StepConfig{}.tip_radius - depth);
}

/// Goes down to a depth at 0.1 m/s and waits there.
inline void press(Driver& driver, double depth) {
  driver.settle(above(-0.002));
  for (double z = -0.002; z < depth; z += 1e-4) driver.at(above(z));
  driver.settle(above(depth));
}

/// n at the anchor; of a free tool at the nearest point.
inline Vec3 normalAt(const MetaModel& model, const ToolResult& r) {
  const ContactSurface& surface = model.contactSurface();
  return surface.mesh().normal(surface.fine(model.surface().closestPoint(vec(r.anchor)).s));
}

}  // namespace palpate::testing
