// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/types.h"
#include "core/model/meta_model.h"

namespace palpate::certify {

/// What touches are drawn from.
struct TouchRange {
  double travel;                 ///< m; abs(d) is 0.2 to 1 of it
  std::optional<double> length;  ///< m; abs(d) of all touches
  bool inward{false};            ///< only directions against the outward normal
};

/// A touch that is asked for.
struct Touch {
  ContactPoint s;
  Vec3 position = Vec3::Zero();  ///< X(s), m
  Vec3 d = Vec3::Zero();         ///< m
};

/// Draws touches: s uniform over the area where the model answers, so nearly always between nodes, the direction of d uniform
/// on the sphere, abs(d) uniform over its range. docs/design.md, Certificate
class TouchSampler {
 public:
  /// Borrows the model. @throw CertifyError  nothing of the surface is accessible
  TouchSampler(const MetaModel& model, const TouchRange& range, std::uint64_t seed);
  [[nodiscard]] Touch next();
  /// Two touches whose places are apart by a distance that is uniform in [from, to], as far as the organ has such places.
  /// @param from, to  straight, m  @throw CertifyError  it has none
  [[nodiscard]] std::array<Touch, 2> nextPair(double from, double to);

 private:
  double uniform();  // [0, 1)
  ContactPoint place();
  Vec3 direction(const ContactPoint& s);

  const MetaModel& model_;
  TouchRange range_;
  std::mt19937_64 random_;
  std::vector<std::int32_t> triangles_;
  std::vector<double> area_up_to_;  // with each triangle, m^2
};

/// The seed that belongs to a content: the first 53 bits of its digest, which JSON readers keep.
[[nodiscard]] std::uint64_t seedOf(const MetaModel& model) noexcept;

}  // namespace palpate::certify
