// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/contact_point.h"
#include "core/base/status_flags.h"
#include "core/base/types.h"
#include "core/contact/coupling.h"

namespace palpate {

/// What a tool remembers from tick to tick about its contact.
struct Contact {
  ContactState state{ContactState::kFree};
  ContactPoint s;              ///< the anchor, a point of the rest surface; when free, the nearest one
  ContactPoint fine;           ///< the same of MetaModel::contactSurface()
  Vec3 anchor = Vec3::Zero();  ///< X(s) of the rest surface, m
  Vec3 normal = Vec3::Zero();  ///< n(s), outward unit normal of the contact surface
  Vec3 imposed =
      Vec3::Zero();  ///< g = c - X - R n(s), X of the contact surface: where the tool wants the patch, m
  CoupledResponse coupled;        ///< d, the organ's answer to it and df/dg; zero when free
  Mat3 stiffness = Mat3::Zero();  ///< df/dc of the force on the organ, sliding included, N/m; zero when free
  Carried carried;                ///< e, displacement of the patch that the other tools cause; the caller's
  std::uint32_t flags{0};         ///< kInContact, kBeyondDomain, kNotAccessible, kAnswerCutShort
  Vec3 from = Vec3::
      Zero();  ///< where the tip was last, free, or would touch at d = 0, as if no tool displaced the surface, m
  double clearance{0.0};    ///< m that it could go from there anywhere without touching
  bool has_side{false};     ///< `from` is known, and which side of the surface it belongs to
  bool overlapping{false};  ///< free, although the tip's sphere reaches into the organ, at `fine`
  bool at_border{false};    ///< the anchor would slide on, out of the accessible part
  bool jumped{false};       ///< the last update made a force that does not follow from the one before
};

}  // namespace palpate
