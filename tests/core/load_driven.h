// SPDX-License-Identifier: Apache-2.0
// What the tests of models driven by force and by load level share.
#pragma once

#include <gtest/gtest.h>

#include <random>

#include "driver.h"

namespace palpate::testing {

class Random {
 public:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vec3 vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Vec3 inBall(double radius) {
    for (;;)
      if (const Vec3 v = vector(radius); v.norm() < radius) return v;
  }
  ContactPoint contactPoint(const MetaModel& model) {
    for (;;) {
      const auto triangle = static_cast<int>(engine_() % static_cast<unsigned>(model.surface().triangles()));
      const double a = uniform(0.0, 1.0), b = uniform(0.0, 1.0 - a);
      if (model.surface().accessible(triangle)) return {triangle, {1.0 - a - b, a, b}};
    }
  }

 private:
  std::mt19937 engine_{17};
};

inline Response answerTo(const MetaModel& model, const ContactPoint& s, const Vec3& d,
                         ResponseStatus expected) {
  Response out;
  EXPECT_EQ(respond(model, s, d, out), expected) << d.transpose();
  return out;
}

inline Response underLoad(const MetaModel& model, const ContactPoint& s, const Vec3& load) {
  Response out;
  EXPECT_NE(respondToLoad(model, s, load, out), ResponseStatus::kNoAnswer);
  return out;
}

/// The contact point that is contact position m.
inline ContactPoint atPosition(const MetaModel& model, std::size_t m) {
  return model.surface().atNode(model.view().contact_node[m]);
}

/// A tool's centre, at a depth below the top of the organ.
inline Vec3 above(const MetaModel& model, double depth) {
  const NearestPoint top = model.surface().closestPoint(Vec3(0.0, 0.0, 1.0));
  return top.position + Vec3(0.0, 0.0, StepConfig{}.tip_radius - depth);
}

}  // namespace palpate::testing
