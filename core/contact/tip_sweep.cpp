// SPDX-License-Identifier: Apache-2.0
#include "core/contact/tip_sweep.h"

#include <algorithm>
#include <cmath>

namespace palpate {

/// Looked up on the rest surface, whose search costs a tenth, where the contact surface cannot be near enough to matter.
TipPlace TipSweep::at(const Vec3& p) const noexcept PALPATE_NONBLOCKING {
  const double bulge = model_.contactSurface().bulge();
  NearestPoint nearest = model_.surface().closestPoint(p);
  TipPlace place;
  if (std::abs(nearest.signed_distance) < radius_ + bulge) {
    nearest = model_.contactSurface().mesh().closestPoint(p);
    place.fine = nearest.s;
    place.clearance = nearest.signed_distance - radius_;
  } else {
    place.fine = model_.contactSurface().fine(nearest.s);
    place.clearance = nearest.signed_distance - radius_ - bulge;
  }
  place.below = place.clearance < 0.0;
  return place;
}

double TipSweep::height(const Vec3& c, const ContactPoint& s) const noexcept PALPATE_NONBLOCKING {
  const SurfaceMesh& surface = model_.contactSurface().mesh();
  const Vec3 gap = c - surface.position(s);
  return std::copysign(gap.norm(), gap.dot(surface.normal(s)));
}

/// Between places that far apart nothing can lie that a sphere of this radius is through before it touches it.
double TipSweep::finest(double length) const noexcept PALPATE_NONBLOCKING {
  constexpr double kFinest = 2.5e-4;  // m
  return std::max({kFinest, 0.5 * radius_, length / kMost});
}

bool TipSweep::touches(const Vec3& from, const Vec3& to) const noexcept PALPATE_NONBLOCKING {
  const double length = (to - from).norm(), least = finest(length);
  if (at(to).below) return true;
  double done = 0.0;
  for (int i = 0; i <= kMost && done < length; ++i) {
    const TipPlace place = at(from + (to - from) * (done / length));
    if (place.below) return true;
    done += std::max(least, place.clearance);
  }
  return false;
}

TipPlace TipSweep::along(const Vec3& from, TipPlace place, const Vec3& to,
                         const TipPlace& to_place) const noexcept PALPATE_NONBLOCKING {
  const double length = (to - from).norm(), least = finest(length);
  ContactPoint entry = place.fine;
  Vec3 here = from;
  double step = place.below ? least : std::max(least, place.clearance);
  double done = 0.0;
  for (int i = 0; i <= kMost && done < length; ++i) {
    done += step;
    const bool arrives = !(done < length);
    const Vec3 before = here;
    here = arrives ? to : Vec3(from + (to - from) * (done / length));
    step = least;
    if (place.below && !comesOut(here, 2.0 * (here - before).norm(), entry, place)) continue;
    place = arrives ? to_place : at(here);
    if (place.below) touch(before, here, place);
    entry = place.fine;
    step = std::max(least, place.clearance);
  }
  return place;
}

/// Which sheet a tip touched that did not touch before: where its centre is not yet so deep that another may be nearer.
void TipSweep::touch(const Vec3& before, const Vec3& p, TipPlace& place) const noexcept PALPATE_NONBLOCKING {
  constexpr int kHalvings = 8;
  constexpr double kDeep = 1e-5;  // m
  Vec3 outside = before, inside = p;
  for (int i = 0; i < kHalvings && place.clearance < -radius_ - kDeep; ++i) {
    const Vec3 middle = 0.5 * (outside + inside);
    const TipPlace there = at(middle);
    (there.below ? inside : outside) = middle;
    if (there.below) place = there;
  }
  model_.contactSurface().mesh().descend(p, 2.0 * (p - inside).norm(), place.fine);
}

/// Whether a tip at p is above its sheet again, on the side where it touched it; else below, beyond a rim or through.
/// @param farthest  that its nearest point of the sheet may have gone, m
bool TipSweep::comesOut(const Vec3& p, double farthest, const ContactPoint& entry,
                        TipPlace& place) const noexcept PALPATE_NONBLOCKING {
  const SurfaceMesh& surface = model_.contactSurface().mesh();
  surface.descend(p, farthest, place.fine);
  if (height(p, place.fine) < radius_) return false;
  if (surface.normal(place.fine).dot(surface.normal(entry)) > 0.0) return true;
  place.fine = entry;
  return false;
}

}  // namespace palpate
