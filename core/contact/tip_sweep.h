// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/contact_point.h"
#include "core/base/types.h"
#include "core/model/meta_model.h"

namespace palpate {

/// Where a tip is against the contact surface at rest.
struct TipPlace {
  ContactPoint
      fine;  ///< of the contact surface: the nearest point; below: one of the sheet that it came in by
  double clearance{0.0};  ///< m that the tip may go anywhere without touching; 0 or less: it touches
  bool below{false};      ///< it touched a sheet on its way, and has not come back out of that one
};

/// The way of a tip past the contact surface, from one pose to the next.                docs/design.md, Contact
/// Its sphere touches a sheet from outside and is below that sheet from then on, however deep, until it comes out of it
/// where the sheet looks to the same side. The way is looked at as far apart as nothing can lie between: what the tip is
/// clear by, or kFinest or half its radius; at most kMost places.
class TipSweep {
 public:
  TipSweep(const MetaModel& model, double tip_radius) noexcept PALPATE_NONBLOCKING : model_(model),
                                                                                     radius_(tip_radius) {}

  /// At p by itself, without a way: below when it touches. Cost of one or two nearest points. Real-time: yes.
  [[nodiscard]] TipPlace at(const Vec3& p) const noexcept PALPATE_NONBLOCKING;
  /// Goes from one place to another. @param to_place  at(to). Real-time: yes.
  [[nodiscard]] TipPlace along(const Vec3& from, TipPlace place, const Vec3& to,
                               const TipPlace& to_place) const noexcept PALPATE_NONBLOCKING;
  /// Whether it touches anything on a way. Real-time: yes.
  [[nodiscard]] bool touches(const Vec3& from, const Vec3& to) const noexcept PALPATE_NONBLOCKING;
  /// How high c lies above the sheet at s: its distance, negative below, m. Real-time: yes.
  [[nodiscard]] double height(const Vec3& c, const ContactPoint& s) const noexcept PALPATE_NONBLOCKING;

  static constexpr int kMost = 32;

 private:
  [[nodiscard]] double finest(double length) const noexcept PALPATE_NONBLOCKING;
  void touch(const Vec3& before, const Vec3& p, TipPlace& place) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool comesOut(const Vec3& p, double went, const ContactPoint& entry,
                              TipPlace& place) const noexcept PALPATE_NONBLOCKING;

  const MetaModel& model_;
  double radius_;
};

}  // namespace palpate
