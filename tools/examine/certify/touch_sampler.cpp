// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/touch_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tools/examine/certify/certify_error.h"

namespace palpate::certify {

TouchSampler::TouchSampler(const MetaModel& model, const TouchRange& range, std::uint64_t seed)
    : model_(model), range_(range), random_(seed) {
  double area = 0.0;
  for (std::int32_t t = 0; t < model.surface().triangles(); ++t) {
    if (!model.surface().accessible(t)) continue;
    const std::array<Vec3, 3> X = model.surface().corners(t);
    area += 0.5 * (X[1] - X[0]).cross(X[2] - X[0]).norm();
    triangles_.push_back(t);
    area_up_to_.push_back(area);
  }
  if (triangles_.empty())
    throw CertifyError("no part of the organ's surface is accessible: nothing to touch");
}

Touch TouchSampler::next() {
  constexpr double kShortest = 0.2;  // of the travel
  Touch touch;
  touch.s = place();
  touch.position = model_.surface().position(touch.s);
  const Vec3 e = direction(touch.s);
  const double length = range_.travel * (kShortest + (1.0 - kShortest) * uniform());
  touch.d = range_.length.value_or(length) * e;
  return touch;
}

std::array<Touch, 2> TouchSampler::nextPair(double from, double to) {
  constexpr int kDistances = 100, kTries = 2000;
  const double near_enough = (to - from) / 20.0;
  for (int distance = 0; distance < kDistances; ++distance) {
    const Touch first = next();
    const double wanted = from + (to - from) * uniform();
    for (int i = 0; i < kTries; ++i) {
      const Touch second = next();
      const double apart = (second.position - first.position).norm();
      if (apart >= from && apart <= to && std::abs(apart - wanted) < near_enough) return {first, second};
    }
  }
  throw CertifyError("the organ has no two places that are " + std::to_string(from) + " to " +
                     std::to_string(to) + " m apart");
}

// Not std::uniform_real_distribution, whose numbers are each library's own.
double TouchSampler::uniform() {
  return static_cast<double>(random_() >> 11U) * 0x1p-53;
}

ContactPoint TouchSampler::place() {
  const auto found =
      std::upper_bound(area_up_to_.begin(), area_up_to_.end() - 1, uniform() * area_up_to_.back());
  const double root = std::sqrt(uniform()), part = uniform();
  return {triangles_[static_cast<std::size_t>(found - area_up_to_.begin())],
          {1.0 - root, root * (1.0 - part), root * part}};
}

Vec3 TouchSampler::direction(const ContactPoint& s) {
  const double z = 2.0 * uniform() - 1.0, angle = 2.0 * std::numbers::pi * uniform(),
               r = std::sqrt(1.0 - z * z);
  const Vec3 e(r * std::cos(angle), r * std::sin(angle), z);
  return range_.inward && e.dot(model_.surface().normal(s)) > 0.0 ? Vec3(-e) : e;
}

std::uint64_t seedOf(const MetaModel& model) noexcept {
  return model.contentHash() >> 11U;
}

}  // namespace palpate::certify
