// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "driver.h"
#include "spoiled_model.h"

namespace palpate::testing {

inline SyntheticOptions forceOptions(int order = 4) {
  return {.subdivisions = 2, .order = order, .parameters = Parameters::kForce};
}

inline const MetaModel& forceModel() {
  static const MetaModel model = loadSynthetic(forceOptions());
  return model;
}

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

inline std::vector<float> field(const MetaModel& model, const ContactPoint& s, const Vec3& parameter) {
  FieldScratch scratch(model);
  std::vector<float> u(model.view().surface_positions.size());
  const std::array<FieldSource, 1> source{FieldSource{s, parameter, 1.0}};
  evaluateField(model, source, scratch, u);
  return u;
}

/// A tool's centre, at a depth below the top of the organ.
inline Vec3 above(const MetaModel& model, double depth) {
  const NearestPoint top = model.surface().closestPoint(Vec3(0.0, 0.0, 1.0));
  return top.position + Vec3(0.0, 0.0, StepConfig{}.tip_radius - depth);
}

/// d_x = 0.003 (x - 1.2 x^2) m, d_y and d_z linear, at every position of a model of order 2.
inline void fold(modelfile::ModelData& data) {
  const std::size_t width = static_cast<std::size_t>(3 * MonomialBasis::size(2));
  for (std::size_t i = 0; i < data.contact_displacement.size(); i += width) {
    std::fill_n(data.contact_displacement.begin() + static_cast<std::ptrdiff_t>(i), width, 0.0);
    for (const std::size_t axis : {0U, 1U, 2U}) data.contact_displacement[i + 4 * axis] = 0.003;
    data.contact_displacement[i + 9] = -0.0036;  // xx of x
  }
}

}  // namespace palpate::testing
