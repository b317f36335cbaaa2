// SPDX-License-Identifier: Apache-2.0
#include "core/contact/equilibrium.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/symmetric_eigen.h"

namespace palpate {

namespace {

bool isPositiveDefinite(const Mat2& A) noexcept PALPATE_NONBLOCKING {
  return A(0, 0) > 0.0 && A.determinant() > 0.0;
}

Mat2 symmetricPart(const Mat2& A) noexcept PALPATE_NONBLOCKING {
  return 0.5 * (A + A.transpose());
}

}  // namespace

Equilibrium::Equilibrium(const MetaModel& model, const ContactLaw& law, double tip_radius, const Vec3& c,
                         Budget& budget, Contact& contact) noexcept PALPATE_NONBLOCKING
    : model_(model),
      law_(law),
      tip_radius_(tip_radius),
      c_(c),
      budget_(budget),
      contact_(contact),
      frame_(model.contactSurface().frame(model.surface(), contact.fine)),
      begin_(touching()) {
  if (contact.state != ContactState::kFree) free_way_ = kFreeWay * (c - begin_ - contact.imposed).norm();
}

Vec3 Equilibrium::touching() const noexcept PALPATE_NONBLOCKING {
  return frame_.position + tip_radius_ * frame_.normal;
}

bool Equilibrium::balance() noexcept PALPATE_NONBLOCKING {
  const Vec3 g = c_ - frame_.position - tip_radius_ * frame_.normal;
  CoupledResponse& coupled = contact_.coupled;
  budget_.spend(Budget::kPlace);
  const PatchResponse patch(model_, contact_.s);
  contact_.anchor = model_.surface().position(contact_.s);
  const Carried carried = contact_.carried.movedTo(contact_.anchor);
  const ResponseStatus status = couple(patch, g, carried, law_, budget_, coupled);
  if (slides() && status != ResponseStatus::kNoAnswer) energy_slope_ = energySlope(patch, carried);
  contact_.normal = frame_.normal;
  contact_.imposed = g;
  contact_.flags = kInContact | (status == ResponseStatus::kBeyond ? kBeyondDomain : 0);
  return status != ResponseStatus::kNoAnswer;
}

/// dE/dxi at fixed d of all tools: of the own part of the energy, and by the force on a patch that the others move.
Vec2 Equilibrium::energySlope(const PatchResponse& patch,
                              const Carried& carried) const noexcept PALPATE_NONBLOCKING {
  const Vec3 slope = ownEnergySlope(patch, carried);
  const Vec2 own = law_.stiffness_scale * (frame_.rates.transpose() * slope);
  if (carried.along == Mat3::Zero()) return own;
  Mat3 corners;
  const auto corner = model_.surface().corners(contact_.s.triangle);
  for (Eigen::Index k = 0; k < 3; ++k) corners.col(k) = corner[static_cast<std::size_t>(k)];
  return own - (carried.along * corners * frame_.rates).transpose() * contact_.coupled.response.force;
}

/// d/dlambda of W - f . e + e . df/dd e / 2, all at d: W at d - e, which may lie far from d, by the tangents that the force
/// goes by. Along e they are differences over a step much shorter than r_max.
Vec3 Equilibrium::ownEnergySlope(const PatchResponse& patch,
                                 const Carried& carried) const noexcept PALPATE_NONBLOCKING {
  constexpr double kStep = 0.02;  // of r_max
  constexpr int kOthers = 2;      // more slopes than a lone tool's
  const CoupledResponse& coupled = contact_.coupled;
  const Vec3& d = coupled.displacement;
  const Vec3 e = carried.at(d), at_d = patch.energySlope(d);
  const double h = kStep * coupled.response.series_radius, length = e.norm();
  if (!(length > 0.0 && h > 0.0)) return at_d;
  budget_.spend(kOthers);
  const double t = std::min(1.0, h / length);
  const Vec3 behind = patch.energySlope(d - t * e), ahead = patch.energySlope(d + t * e);
  return at_d - (ahead - behind) / (2.0 * t) + (ahead - 2.0 * at_d + behind) / (2.0 * t * t);
}

Equilibrium::Slip Equilibrium::slip() const noexcept PALPATE_NONBLOCKING {
  const Vec3& f = contact_.coupled.response.force;
  const Mat23 tangent = frame_.tangent.transpose();
  const Mat32 offset = frame_.along + tip_radius_ * frame_.turning;
  const double pressing = std::max(0.0, -f.dot(frame_.normal));
  Slip slip;
  slip.per_tip = inverseStretch(tangent * offset);
  slip.T = tangent * f - slip.per_tip * energy_slope_;
  slip.way = tangent * (touching() - begin_);
  slip.A = stiffnessAgainst(pressing, slip.per_tip);
  slip.holding.friction = law_.friction * pressing;
  slip.holding.drag = pressing / (kViscousSpeed * law_.period);
  slip.holding.free_way = free_way_;
  if (law_.friction > 0.0)
    slip.holding.growth =
        law_.friction * (contact_.coupled.stiffness * offset * slip.per_tip).transpose() * frame_.normal;
  slip.holding.friction -= slip.holding.growth.dot(slip.way);  // at the begin of the way
  return slip;
}

/// d(anchor's way)/d(tip's way), (1 + R kappa)^-1. The tip's way is taken as a tenth at least of the anchor's, where a tip of
/// this radius can hardly roll or not at all (a hollow sharper than itself).
Mat2 Equilibrium::inverseStretch(const Mat2& stretch) noexcept PALPATE_NONBLOCKING {
  constexpr double kLeast = 0.1;
  const SymmetricEigen<Mat2> eigen = symmetricEigen<Mat2>(symmetricPart(stretch));
  const Vec2 inverse(1.0 / std::max(eigen.values[0], kLeast), 1.0 / std::max(eigen.values[1], kLeast));
  return eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose();
}

/// -dT/d(tip's way). Where it is not stable (a ridge sharper than the tool's tip can ride on) the part that is.
Mat2 Equilibrium::stiffnessAgainst(double pressing, const Mat2& per_tip) const noexcept PALPATE_NONBLOCKING {
  const Mat3& K = contact_.coupled.stiffness;
  const Mat23 tangent = frame_.tangent.transpose();
  const Mat32 offset = frame_.along + tip_radius_ * frame_.turning;
  const Mat2 A = symmetricPart((tangent * K * offset - pressing * tangent * frame_.turning) * per_tip);
  if (isPositiveDefinite(A)) return A;
  const Mat2 plain = symmetricPart(tangent * K * frame_.tangent);
  return isPositiveDefinite(plain) ? plain : Mat2(K.norm() * Mat2::Identity());
}

/// What the tangential force is more than what holds the tip back, along its way.
Vec2 Equilibrium::missing(const Slip& slip) noexcept PALPATE_NONBLOCKING {
  constexpr double kStill = 1e-12;  // m
  const double hold = slip.holding.at(slip.way), length = slip.way.norm();
  if (length > kStill) return slip.T - hold / length * slip.way;
  const double size = slip.T.norm();
  return size > hold ? Vec2(slip.T * (1.0 - hold / size)) : Vec2::Zero();
}

Vec2 Equilibrium::stepOf(const Slip& slip) noexcept PALPATE_NONBLOCKING {
  constexpr double kLongestStep = 2e-3;  // m
  const Vec2 way = wayAgainst(slip.holding, slip.T + slip.A * slip.way, slip.A);
  const Vec2 step = slip.per_tip * (way - slip.way);
  return step * std::min(1.0, kLongestStep / std::max(step.norm(), kLongestStep));
}

/// Moves the anchor. @return false when it did not move, or the model has no answer at the new place
bool Equilibrium::slideBy(const Vec2& step) noexcept PALPATE_NONBLOCKING {
  constexpr double kShortestStep = 1e-9;  // m
  if (!step.allFinite()) return false;
  const Contact before = contact_;
  const TangentFrame frame = frame_;
  const Vec2 energy_slope = energy_slope_;
  const SurfaceMesh& surface = model_.contactSurface().mesh();
  const bool went = surface.move(contact_.fine, frame_.tangent * step, Reach::kAccessible);
  contact_.s = model_.contactSurface().rest(contact_.fine);
  frame_ = model_.contactSurface().frame(model_.surface(), contact_.fine);
  contact_.at_border = !went;
  const bool stayed =
      !went && (contact_.anchor - model_.surface().position(contact_.s)).norm() < kShortestStep;
  if (balance() && !budget_.cut()) return !stayed;  // at the border the next step may lead back inside
  contact_ = before;
  frame_ = frame;
  energy_slope_ = energy_slope;
  return false;
}

/// Friction cannot be judged by a load of fixed direction: its anchor sticks.
bool Equilibrium::slides() const noexcept PALPATE_NONBLOCKING {
  return std::isfinite(law_.friction) && model_.attributes().parameters != Parameters::kLevel;
}

bool Equilibrium::slide() noexcept PALPATE_NONBLOCKING {
  constexpr double kTolerance = 1e-6;   // of |f|
  constexpr double kLeastForce = 1e-7;  // N
  contact_.at_border = false;
  contact_.state = ContactState::kStick;
  if (!balance()) return false;
  const Response& response = contact_.coupled.response;
  if (!slides() || !response.force.allFinite()) return true;
  if (contact_.coupled.stiffness == Mat3::Zero())
    return true;  // beyond a fold no direction to slide is known
  int stopped = 0;
  Slip now = slip();
  const auto slips = [&] { return missing(now).norm() > kTolerance * response.force.norm() + kLeastForce; };
  for (int i = 0; i < kMaxSlides && slips() && budget_.allows(); ++i) {
    contact_.state = ContactState::kSlide;
    const Vec2 step = stepOf(now);
    const TangentFrame frame = frame_;
    if (!slideBy(step) && ++stopped == 2) break;  // at the border: the first step may have gone too far
    now = learned(slip(), frame, now);
  }
  if (contact_.state == ContactState::kSlide) giveWay(now);
  return true;
}

/// A does not know how dW/ds changes along the way; the last step shows it (Broyden's update, C. G. Broyden,
/// Math. Comp. 19 (1965) 577-593).
Equilibrium::Slip Equilibrium::learned(Slip next, const TangentFrame& frame,
                                       const Slip& from) const noexcept PALPATE_NONBLOCKING {
  const Mat2 turn = frame_.tangent.transpose() * frame.tangent;
  const Vec2 way = next.way - turn * from.way;
  const Vec2 missed = next.T - turn * from.T + next.A * way;
  const Mat2 A = symmetricPart(next.A - missed * way.transpose() / way.squaredNorm());
  if (A.allFinite() && isPositiveDefinite(A)) next.A = A;
  return next;
}

/// dX/dc of an anchor that slides: what holds it back turns with its way.
void Equilibrium::giveWay(const Slip& now) noexcept PALPATE_NONBLOCKING {
  const Mat3& K = contact_.coupled.stiffness;
  const double length = now.way.norm(), hold = now.holding.at(now.way);
  if (!(length > 0.0)) return;
  const Vec2 t = now.way / length;
  const double beyond = length > now.holding.free_way ? now.holding.drag : 0.0;
  Mat2 J = now.A + hold / length * (Mat2::Identity() - t * t.transpose()) + beyond * t * t.transpose();
  J += t * now.holding.growth.transpose();
  const Eigen::RowVector3d normal_part = frame_.normal.transpose() * K;
  give_ = frame_.tangent * now.per_tip * J.inverse() *
          (frame_.tangent.transpose() * K + law_.friction * t * normal_part);
  if (!give_.allFinite()) give_.setZero();
}

Mat3 Equilibrium::stiffness() const noexcept PALPATE_NONBLOCKING {
  const Mat3& K = contact_.coupled.stiffness;
  if (contact_.at_border) return K;
  return K - K * (frame_.along + tip_radius_ * frame_.turning) * frame_.tangent.transpose() * give_;
}

}  // namespace palpate
