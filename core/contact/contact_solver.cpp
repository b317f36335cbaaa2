// SPDX-License-Identifier: Apache-2.0
#include "core/contact/contact_solver.h"

#include <algorithm>

#include "core/contact/equilibrium.h"
#include "core/contact/tip_sweep.h"

namespace palpate {

namespace {

constexpr double kSmallForce = 1e-3;  // N, less than a device shows

/// Whether the organ would pull the tool, or a load that can only push (Parameters::kLevel) gives a withdrawn tool no
/// force. NaN does not count as pulling: the tick finds it.
bool pulls(const Contact& contact) noexcept PALPATE_NONBLOCKING {
  const Vec3& f = contact.coupled.response.force;
  if (f == Vec3::Zero() && contact.imposed.dot(contact.normal) > 0.0) return true;
  return f.dot(contact.normal) > 0.0;
}

/// Releases the contact. A remaining force is a jump.
void letGo(ContactJump jump, Contact& contact) noexcept PALPATE_NONBLOCKING {
  const bool felt = !(contact.coupled.response.force.norm() < kSmallForce);
  ContactSolver::release(contact);
  contact.jump = felt ? jump : ContactJump::kNone;
}

/// Whether the tip is no deeper than one tick can bring it, and its force is explained by that. In the dent of
/// another tool the tangent may give it a force at once.
bool beganSoftly(const Contact& contact) noexcept PALPATE_NONBLOCKING {
  constexpr double kDeep = 1e-3;  // m; from outside a tool has to be faster than 1 m/s for that
  const double depth = (contact.imposed - contact.carried.constant).norm();
  const double owed = contact.coupled.stiffness.norm() * depth;
  return depth <= kDeep && contact.coupled.response.force.norm() <= owed + kSmallForce;
}

/// What the patch moved as the model shows it: no farther than what others do by themselves and the field of the tool goes. At the
/// border of the accessible part an anchor waits, with a displacement along the surface that no friction would hold.
Vec3 shown(const Contact& contact) noexcept PALPATE_NONBLOCKING {
  const Response& response = contact.coupled.response;
  Vec3 d = response.displacement;
  if (contact.carried.constant != Vec3::Zero()) {
    const double most = response.shown_radius + contact.carried.constant.norm();
    d = contact.coupled.displacement;
    d *= std::min(1.0, most / std::max(d.norm(), most));
  }
  return contact.at_border ? Vec3(contact.normal * contact.normal.dot(d)) : d;
}

}  // namespace

bool ContactSolver::update(const MetaModel& model, const ContactLaw& law, const Vec3& c, TipWay way,
                           Budget& budget, Contact& contact) const noexcept PALPATE_NONBLOCKING {
  const Contact before = contact;
  contact.jump = ContactJump::kNone;
  if (way == TipWay::kNone) forget(contact);
  if (way == TipWay::kUnseen) loseWay(model, c, contact);
  if (contact.isFree())
    tryCapture(model, law, c, budget, contact);
  else
    follow(model, law, c, budget, contact);
  if (budget.cut()) contact.flags |= kAnswerCutShort;
  if (contact.coupled.response.force.allFinite() && contact.stiffness.allFinite()) return true;
  contact = before;
  return false;
}

/// Nobody saw where the tool went: round the organ, if it is clear of it; else it is taken to have stayed where it was if it
/// is not farther from there than a tool may go unseen.
void ContactSolver::loseWay(const MetaModel& model, const Vec3& c,
                            Contact& contact) const noexcept PALPATE_NONBLOCKING {
  constexpr double kUnseen = 0.04;  // m
  const bool held = !contact.isFree();
  const Vec3 at_rest = c - contact.carried.constant;
  const bool clear = !TipSweep(model, tip_radius_).at(at_rest).below;
  if (clear && held) letGo(ContactJump::kLeftUnseen, contact);
  if (clear || (!held && (at_rest - contact.from).norm() > kUnseen)) contact.has_side = false;
}

/// Where the tip would be at d = 0.
Vec3 ContactSolver::touching(const MetaModel& model,
                             const Contact& contact) const noexcept PALPATE_NONBLOCKING {
  return model.contactSurface().mesh().position(contact.fine) + tip_radius_ * contact.normal;
}

void ContactSolver::follow(const MetaModel& model, const ContactLaw& law, const Vec3& c, Budget& budget,
                           Contact& contact) const noexcept PALPATE_NONBLOCKING {
  constexpr double kFar = 1e-3;          // m
  constexpr double kOfTheTipsWay = 5.0;  // a slide follows the tip
  const Vec3 there = touching(model, contact), tip = there + contact.imposed;
  contact.from = there;
  contact.clearance = 0.0;
  contact.has_side = true;
  hold(model, law, c, budget, contact);
  if (contact.isFree()) return;
  contact.from = touching(model, contact);
  const double way = (contact.from - there).norm();
  if (way > kFar && way > kOfTheTipsWay * (c - tip).norm()) contact.jump = ContactJump::kSnapped;
  const Vec3 at_rest = c - shown(contact);
  if (!hasLeft(model, at_rest, contact)) return;
  letGo(ContactJump::kReleasedWithForce, contact);
  contact.from = at_rest;
}

/// Whether the tip has left what the anchor is on: lowered from above the anchor's tangent plane to where it is, along n(s), it
/// touches nothing. So not by being on the other side of what it presses.
bool ContactSolver::hasLeft(const MetaModel& model, const Vec3& at_rest,
                            const Contact& contact) const noexcept PALPATE_NONBLOCKING {
  constexpr double kHysteresis = 5e-4;  // m beyond the capture distance, so that noise does not toggle
  const double reach = tip_radius_ + kHysteresis;
  const Vec3 gap = at_rest - model.contactSurface().mesh().position(contact.fine);
  const double above = gap.dot(contact.normal);
  const bool touches_anchor =
      gap.norm() < reach || (above < reach && gap.cross(contact.normal).norm() < reach);
  if (touches_anchor) return false;
  const Vec3 up = contact.normal * std::max(0.0, reach - above);
  return !TipSweep(model, reach).touches(at_rest + up, at_rest);
}

void ContactSolver::release(Contact& contact) noexcept PALPATE_NONBLOCKING {
  contact.state = ContactState::kFree;
  contact.imposed.setZero();
  contact.coupled = CoupledResponse{};
  contact.stiffness.setZero();
  contact.flags = 0;
  contact.overlapping = false;
  contact.at_border = false;
}

void ContactSolver::forget(Contact& contact) noexcept PALPATE_NONBLOCKING {
  release(contact);
  contact.has_side = false;
  contact.carried = {};  // it is that of the old anchor
}

/// Goes on to a place of the surface at rest. @return whether the tip touches there, at `fine`, or went through it
bool ContactSolver::arrivesBelow(const MetaModel& model, const Vec3& at_rest, bool was_below,
                                 Contact& contact) const noexcept PALPATE_NONBLOCKING {
  const TipSweep sweep(model, tip_radius_);
  TipPlace place = sweep.at(at_rest);
  const double length = (at_rest - contact.from).norm();
  const bool cannot_touch =
      !place.below && (was_below || length < contact.clearance + std::max(0.0, place.clearance));
  if (contact.has_side && !cannot_touch)
    place = sweep.along(contact.from, {contact.fine, contact.clearance, was_below}, at_rest, place);
  contact.from = at_rest;
  contact.clearance = place.below ? 0.0 : place.clearance;
  contact.has_side = contact.has_side || !place.below;
  contact.fine = place.fine;
  return place.below;
}

/// Puts the anchor of a tip that touches where it lies straight above or below. @return whether that is nearer than R
bool ContactSolver::settlesBelow(const MetaModel& model, const Vec3& at_rest,
                                 Contact& contact) const noexcept PALPATE_NONBLOCKING {
  const SurfaceMesh& surface = model.contactSurface().mesh();
  ContactPoint straight = contact.fine;
  double height = 0.0;
  if (!surface.project(at_rest, straight, height)) return true;
  if (surface.normal(straight).dot(surface.normal(contact.fine)) <= 0.0) return true;  // round a rim
  contact.fine = straight;
  return height < tip_radius_;
}

void ContactSolver::tryCapture(const MetaModel& model, const ContactLaw& law, const Vec3& c, Budget& budget,
                               Contact& contact) const noexcept PALPATE_NONBLOCKING {
  const bool was_overlapping = contact.overlapping;
  release(contact);
  const Vec3 at_rest = c - contact.carried.constant;  // as other tools displaced the surface
  contact.overlapping =
      arrivesBelow(model, at_rest, was_overlapping, contact) && settlesBelow(model, at_rest, contact);
  contact.s = model.contactSurface().rest(contact.fine);
  contact.anchor = model.surface().position(contact.s);
  contact.normal = model.contactSurface().mesh().normal(contact.fine);
  if (!contact.overlapping) return;
  if (!model.surface().reachable(contact.s.triangle)) {
    contact.flags = kNotAccessible;
    return;
  }
  const ContactPoint sheet = contact.fine;
  contact.coupled.displacement.setZero();
  hold(model, law, c, budget, contact);
  contact.overlapping = contact.isFree();
  if (contact.overlapping) {
    contact.fine = sheet;
    contact.jump = ContactJump::kNone;  // the force was zero, and is
    return;
  }
  if (was_overlapping || !beganSoftly(contact)) contact.jump = ContactJump::kDeepCapture;
}

void ContactSolver::hold(const MetaModel& model, const ContactLaw& law, const Vec3& c, Budget& budget,
                         Contact& contact) const noexcept PALPATE_NONBLOCKING {
  Equilibrium equilibrium(model, law, tip_radius_, c, budget, contact);
  if (!equilibrium.slide() || pulls(contact)) return letGo(ContactJump::kReleasedWithForce, contact);
  contact.stiffness = equilibrium.stiffness();
  if (contact.at_border) contact.flags |= kNotAccessible;
}

}  // namespace palpate
