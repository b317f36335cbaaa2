// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/contact_solver.h"

#include <cmath>

namespace palpate {

namespace {

/// Unit vector from the nearest point to the tip's centre, turned outward when the centre is inside.
Vec3 outwardDirection(const NearestPoint& nearest, const Vec3& c, const Vec3& normal) noexcept {
  constexpr double kTinyDistance = 1e-9;  // m; nearer than this the direction is rounding noise
  const double distance = nearest.signed_distance;
  return std::abs(distance) > kTinyDistance ? Vec3((c - nearest.position) / distance) : normal;
}

/// Looks up the organ's answer to the contact's d. @return false when the organ would have to pull the tool, or
/// gives no force to one that is withdrawn: a load that only pushes (Parameters::kLevel) cannot pull. What is no
/// number does not pull: it is left for the tick to find.
bool answer(const MetaModel& model, Contact& contact) noexcept {
  const ResponseStatus status = respond(model, contact.s, contact.displacement, contact.response);
  contact.flags = kInContact;
  if (status == ResponseStatus::kClamped) contact.flags |= kBeyondDomain;
  if (status == ResponseStatus::kNoAnswer) return false;
  const Vec3& f = contact.response.force;
  if (f == Vec3::Zero() && contact.displacement.dot(contact.normal) > 0.0) return false;
  return !(f.dot(contact.normal) > 0.0);
}

}  // namespace

void ContactSolver::update(const MetaModel& model, const Vec3& c,
                           Contact& contact) const noexcept PALPATE_NONBLOCKING {
  if (contact.state == ContactState::kFree)
    tryCapture(model, c, contact);
  else if (hasLeft(model, c))
    leave(contact);
  else
    stick(model, c, contact);
}

bool ContactSolver::hasLeft(const MetaModel& model, const Vec3& c) const noexcept PALPATE_NONBLOCKING {
  constexpr double kHysteresis = 5e-4;  // m beyond the capture distance, so that noise does not toggle
  return model.surface().closestPoint(c).signed_distance >= tip_radius_ + kHysteresis;
}

void ContactSolver::leave(Contact& contact) noexcept PALPATE_NONBLOCKING {
  release(contact);
  contact.overlapping = false;
  contact.jumped = true;  // the tangential part did not fade on the way
}

void ContactSolver::release(Contact& contact) noexcept PALPATE_NONBLOCKING {
  contact.state = ContactState::kFree;
  contact.displacement.setZero();
  contact.response = Response{};
  contact.flags = 0;
}

void ContactSolver::tryCapture(const MetaModel& model, const Vec3& c,
                               Contact& contact) const noexcept PALPATE_NONBLOCKING {
  constexpr double kDeepCapture =
      1e-3;  // m; a tool that comes from outside has to be faster than 1 m/s for that
  const bool was_overlapping = contact.overlapping;
  const NearestPoint nearest = model.surface().closestPoint(c);
  release(contact);
  contact.s = nearest.s;
  contact.anchor = nearest.position;
  contact.normal = model.surface().normal(nearest.s);
  contact.jumped = false;
  contact.overlapping = nearest.signed_distance < tip_radius_;
  if (!contact.overlapping) return;
  if (!model.surface().accessible(nearest.s.triangle) || model.surface().mix(nearest.s).count == 0) {
    contact.flags = kNotAccessible;
    return;
  }
  contact.direction = outwardDirection(nearest, c, contact.normal);
  stick(model, c, contact);
  contact.jumped = was_overlapping || tip_radius_ - nearest.signed_distance > kDeepCapture;
}

void ContactSolver::stick(const MetaModel& model, const Vec3& c,
                          Contact& contact) const noexcept PALPATE_NONBLOCKING {
  contact.state = ContactState::kStick;
  contact.displacement = c - contact.anchor - tip_radius_ * contact.direction;
  contact.jumped = false;
  if (answer(model, contact)) return;
  release(contact);
  contact.overlapping = true;  // until the next tick has looked
  contact.jumped = true;       // a tangential part may have been left
}

}  // namespace palpate
