// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/contact_point.h"
#include "core/base/status_flags.h"
#include "core/base/types.h"
#include "core/contact/coupling.h"

namespace palpate {

/// Why a contact's force is not continuous in the tip's place.
enum class ContactJump : std::uint8_t {
  kNone,
  /// Let go while a force of 1 mN or more was left, along the surface.
  kReleasedWithForce,
  /// Nobody saw the tip's way, and it is clear of the organ: a force of 1 mN or more is gone.
  kLeftUnseen,
  /// Caught deeper than one tick brings a tool, or with more force than its depth explains.
  kDeepCapture,
  /// The anchor went from one balance to another, much farther than its tip.
  kSnapped,
};

/// What a tool remembers from tick to tick about its contact. Owned by core/contact: only what is in that folder writes a
/// field of it (ToolGroup `carried`, Equilibrium the balance, ContactSolver the rest); others hold it and read it.
struct Contact {
  // The balance
  ContactState state{ContactState::kFree};
  ContactPoint s;              ///< the anchor, a point of the rest surface; when free, the nearest one
  ContactPoint fine;           ///< the same of MetaModel::contactSurface()
  Vec3 anchor = Vec3::Zero();  ///< X(s) of the rest surface, m
  Vec3 normal = Vec3::Zero();  ///< n(s), outward unit normal of the contact surface
  Vec3 imposed =
      Vec3::Zero();  ///< g = c - X - R n(s), X of the contact surface: where the tool wants the patch, m
  CoupledResponse coupled;  ///< d, the organ's answer to it and df/dg; zero when free
  std::uint32_t flags{0};   ///< kInContact, kBeyondDomain, kNotAccessible, kAnswerCutShort
  bool at_border{false};    ///< the anchor would slide on, out of the accessible part
  // What it feels of the other tools
  Carried carried;  ///< e, displacement of the patch that the other tools cause
  // The rest
  Mat3 stiffness = Mat3::Zero();  ///< df/dc of the force on the organ, sliding included, N/m; zero when free
  Vec3 from = Vec3::
      Zero();  ///< where the tip was last, free, or would touch at d = 0, as if no tool displaced the surface, m
  double clearance{0.0};    ///< m that it could go from there anywhere without touching
  bool has_side{false};     ///< `from` is known, and which side of the surface it belongs to
  bool overlapping{false};  ///< free, although the tip's sphere reaches into the organ, at `fine`
  ContactJump jump{ContactJump::kNone};  ///< what the last update did

  [[nodiscard]] bool jumped() const noexcept PALPATE_NONBLOCKING { return jump != ContactJump::kNone; }
  [[nodiscard]] bool isFree() const noexcept PALPATE_NONBLOCKING { return state == ContactState::kFree; }
};

}  // namespace palpate
