// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/contact_solver.h"

#include <cmath>

#include "equilibrium.h"

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

/// Releases the contact. A remaining force, along the surface, is a jump.
void letGo(Contact& contact) noexcept PALPATE_NONBLOCKING {
  const bool felt = !(contact.coupled.response.force.norm() < kSmallForce);
  ContactSolver::release(contact);
  contact.jumped = felt;
}

/// Whether the tip is no deeper than one tick can bring it, and its force is explained by that. In the dent of
/// another tool the tangent may give it a force at once.
bool beganSoftly(const Contact& contact) noexcept PALPATE_NONBLOCKING {
  constexpr double kDeep = 1e-3;  // m; from outside a tool has to be faster than 1 m/s for that
  const double depth = (contact.imposed - contact.carried.constant).norm();
  const double owed = contact.coupled.stiffness.norm() * depth;
  return depth <= kDeep && contact.coupled.response.force.norm() <= owed + kSmallForce;
}

}  // namespace

void ContactSolver::update(const MetaModel& model, const ContactLaw& law, const Vec3& c,
                           Contact& contact) const noexcept PALPATE_NONBLOCKING {
  contact.jumped = false;
  if (contact.state == ContactState::kFree)
    tryCapture(model, law, c, contact);
  else if (hasLeft(model, c, contact))
    letGo(contact);
  else
    follow(model, law, c, contact);
}

void ContactSolver::follow(const MetaModel& model, const ContactLaw& law, const Vec3& c,
                           Contact& contact) const noexcept PALPATE_NONBLOCKING {
  constexpr double kFar = 1e-3;          // m
  constexpr double kOfTheTipsWay = 5.0;  // a slide follows the tip
  const auto touching = [&] {            // where the tip is at d = 0
    return Vec3(model.contactSurface().mesh().position(contact.fine) + tip_radius_ * contact.normal);
  };
  const Vec3 there = touching(), tip = there + contact.imposed;
  hold(model, law, c, contact);
  const double way = (touching() - there).norm();
  if (way > kFar && way > kOfTheTipsWay * (c - tip).norm()) contact.jumped = true;
}

bool ContactSolver::hasLeft(const MetaModel& model, const Vec3& c,
                            const Contact& contact) const noexcept PALPATE_NONBLOCKING {
  constexpr double kHysteresis = 5e-4;  // m beyond the capture distance, so that noise does not toggle
  const double reach = tip_radius_ + kHysteresis;
  const Vec3 at_rest = c - contact.carried.at(contact.coupled.displacement);
  const SurfaceMesh& surface = model.contactSurface().mesh();
  if ((at_rest - surface.position(contact.fine)).norm() < reach) return false;
  const double distance = model.surface().closestPoint(at_rest).signed_distance;
  const double bulge = model.contactSurface().bulge();
  if (std::abs(distance - reach) > bulge) return distance > reach;
  return surface.closestPoint(at_rest).signed_distance >= reach;
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

/// Where the tip would touch: found on the rest surface, whose search costs a tenth, where the contact surface cannot
/// be near enough to matter. @return how high above that point, along its normal there, m
double ContactSolver::lookFor(const MetaModel& model, const Vec3& c,
                              Contact& contact) const noexcept PALPATE_NONBLOCKING {
  const SurfaceMesh& surface = model.contactSurface().mesh();
  const double near = tip_radius_ + model.contactSurface().bulge();
  NearestPoint nearest = model.surface().closestPoint(c);
  contact.fine = model.contactSurface().fine(nearest.s);
  const bool is_near = std::abs(nearest.signed_distance) < near;
  if (is_near) {
    nearest = surface.closestPoint(c);
    contact.fine = nearest.s;
  }
  double height = nearest.signed_distance;
  if (is_near && height < tip_radius_) (void)surface.project(c, contact.fine, height);
  contact.s = model.contactSurface().rest(contact.fine);
  contact.anchor = model.surface().position(contact.s);
  contact.normal = surface.normal(contact.fine);
  return height;
}

void ContactSolver::tryCapture(const MetaModel& model, const ContactLaw& law, const Vec3& c,
                               Contact& contact) const noexcept PALPATE_NONBLOCKING {
  const bool was_overlapping = contact.overlapping;
  release(contact);
  const double height =
      lookFor(model, c - contact.carried.constant, contact);  // as other tools displaced the surface
  contact.overlapping = height < tip_radius_;
  if (!contact.overlapping) return;
  if (!model.surface().reachable(contact.s.triangle)) {
    contact.flags = kNotAccessible;
    return;
  }
  contact.coupled.displacement.setZero();
  hold(model, law, c, contact);
  if (contact.state == ContactState::kFree) return;
  contact.overlapping = false;
  contact.jumped = was_overlapping || !beganSoftly(contact);
}

void ContactSolver::hold(const MetaModel& model, const ContactLaw& law, const Vec3& c,
                         Contact& contact) const noexcept PALPATE_NONBLOCKING {
  Equilibrium equilibrium(model, law, tip_radius_, c, contact);
  if (!equilibrium.slide() || pulls(contact)) return letGo(contact);
  contact.stiffness = equilibrium.stiffness();
  if (contact.at_border) contact.flags |= kNotAccessible;
}

}  // namespace palpate
