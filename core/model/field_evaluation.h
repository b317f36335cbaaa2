// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/index.h"
#include "core/base/max_tools.h"
#include "core/base/types.h"
#include "core/model/meta_model.h"
#include "core/model/near_parts.h"

namespace palpate {

/// Fields of a "displacement" model end at this many r_max.
inline constexpr double kShownRadii = 2.0;

/// The functions that fields are sums of. Beyond abs(d) = limit those of a "displacement" model are extrapolated linearly along
/// d, up to kShownRadii limits; then they stay, as those of a load-driven model do at the limit. docs/design.md, Series
/// @param limit  m, N or 1  @param[out] values  functions().size(). @return the parameter as far as fields go. Real-time: yes.
Vec3 fieldFunctions(const MetaModel& model, const Vec3& parameter, double limit,
                    std::span<double> values) noexcept PALPATE_NONBLOCKING;

/// Their gradients by d, 1/m, of a "displacement" model; beyond kShownRadii limits, where a tool's own part goes on in proportion
/// (ownPart()), those of that. @param[out] gradient  functions().size(). Real-time: yes.
void fieldGradients(const MetaModel& model, const Vec3& d, double limit,
                    std::span<Vec3> gradient) noexcept PALPATE_NONBLOCKING;

/// Scratch of the field evaluation; one per thread, allocated before the loop.
struct FieldScratch {
  explicit FieldScratch(const MetaModel& model);
  std::vector<float> amplitudes;  ///< [n] y, m
  std::vector<float> near_block;  ///< the largest of positions and edges
  PatchNodes patch;               ///< of the tool that is being evaluated
  PatchSources loads;             ///< of its patch
  UnitNear unit_near;             ///< near fields of these loads
};

/// One tool's part in a field.
struct FieldSource {
  ContactPoint s;
  Vec3 parameter = Vec3::Zero();  ///< Response::parameter
  double gain{1.0};               ///< any finite number

  [[nodiscard]] bool operator==(const FieldSource& other) const noexcept {
    return s == other.s && parameter == other.parameter && gain == other.gain;
  }
};

/// Displacement of the surface nodes, far plus near field, superposed over the tools (docs/design.md, Parts).
/// @param[out] u  [Ns][3], m, overwritten; zero when no source is accessible. Cost O(n Ns). Real-time: yes.
void evaluateField(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
                   std::span<float> u) noexcept PALPATE_NONBLOCKING;

/// The field where tools are, m, without what tools of a "displacement" model do at each other's places (addOthersAt()): there
/// it is what sources at a point itself add, from a table (ContactDimple). @param points  triangle -1: zero there
/// @param[out] u  [points]. Cost O(points C), of a load-driven model O(sources (C n + points K)). Real-time: yes.
void fieldAt(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
             std::span<const ContactPoint> points, std::span<Vec3> u) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
