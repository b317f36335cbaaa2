// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "palpate/core/contact_point.h"
#include "palpate/core/meta_model.h"
#include "palpate/core/response.h"
#include "palpate/core/status_flags.h"
#include "palpate/core/types.h"

namespace palpate {

/// What a tool remembers from tick to tick about its contact.
struct Contact {
  ContactState state{ContactState::kFree};
  ContactPoint s;              ///< the anchor; when free, the nearest point of the rest surface
  Vec3 anchor = Vec3::Zero();  ///< X(s), m
  /// m, outward unit vector from the anchor to the tip's centre, set at capture
  Vec3 direction = Vec3::Zero();
  Vec3 normal = Vec3::Zero();        ///< n(s), outward unit normal of the rest surface
  Vec3 displacement = Vec3::Zero();  ///< d as imposed, before clamping, m
  Response response;                 ///< the organ's answer; zero when free
  std::uint32_t flags{0};            ///< kInContact, kBeyondDomain, kNotAccessible
  bool overlapping{false};           ///< free, although the tip's sphere reaches into the organ
  bool jumped{false};  ///< the last update made a force that does not follow from the one before
};

/// Moves a tool through free and stick                                                  DESIGN 3.1
///   free -> stick: signed distance of the tip's centre < R on an accessible triangle;
///                  the anchor s is the nearest point
///   stick:         d = c - X(s) - R m, with s and m as set at capture
///   stick -> free: f . n > 0, the tool would pull; or the tip's sphere, grown by 0.5 mm, has left the
///                  rest surface: a tool drawn off sideways is not held from afar
/// Differs from DESIGN 3.1 for now: friction and sliding (kSlide) are not there, an anchor sticks until
/// release.
class ContactSolver {
 public:
  explicit ContactSolver(double tip_radius) noexcept : tip_radius_(tip_radius) {}

  /// One tick of one tool. @param c  tip centre, W, m, finite. At most one change of state. Real-time: yes.
  /// Sets `jumped` where the force is not continuous in c: at release, and at a capture that is deep at once.
  void update(const MetaModel& model, const Vec3& c, Contact& contact) const noexcept PALPATE_NONBLOCKING;
  /// Frees the tool: no force, no displacement; the anchor stays as the nearest point known. Real-time: yes.
  static void release(Contact& contact) noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] bool hasLeft(const MetaModel& model, const Vec3& c) const noexcept PALPATE_NONBLOCKING;
  static void leave(Contact& contact) noexcept PALPATE_NONBLOCKING;
  void tryCapture(const MetaModel& model, const Vec3& c, Contact& contact) const noexcept PALPATE_NONBLOCKING;
  void stick(const MetaModel& model, const Vec3& c, Contact& contact) const noexcept PALPATE_NONBLOCKING;

  double tip_radius_;
};

}  // namespace palpate
