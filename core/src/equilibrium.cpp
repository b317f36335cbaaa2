// SPDX-License-Identifier: Apache-2.0
#include "equilibrium.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "symmetric_eigen.h"

namespace palpate {

namespace {

bool isNegativeDefinite(const Mat2& A) noexcept PALPATE_NONBLOCKING {
  const Mat2 S = 0.5 * (A + A.transpose());
  return S(0, 0) < 0.0 && S.determinant() > 0.0;
}

}  // namespace

Equilibrium::Equilibrium(const MetaModel& model, const ContactLaw& law, double tip_radius, const Vec3& c,
                         Contact& contact) noexcept PALPATE_NONBLOCKING
    : model_(model),
      law_(law),
      tip_radius_(tip_radius),
      c_(c),
      contact_(contact),
      frame_(model.contactSurface().frame(model.surface(), contact.fine)) {}

bool Equilibrium::balance() noexcept PALPATE_NONBLOCKING {
  const Vec3 g = c_ - frame_.position - tip_radius_ * frame_.normal;
  CoupledResponse& coupled = contact_.coupled;
  const PatchResponse patch(model_, contact_.s);
  const ResponseStatus status = couple(patch, g, contact_.carried, law_, coupled);
  if (slides() && status != ResponseStatus::kNoAnswer)
    energy_slope_ =
        law_.stiffness_scale * (frame_.rates.transpose() * patch.energySlope(coupled.displacement));
  contact_.anchor = model_.surface().position(contact_.s);
  contact_.normal = frame_.normal;
  contact_.imposed = g;
  contact_.flags = kInContact | (status == ResponseStatus::kClamped ? kBeyondDomain : 0);
  return status != ResponseStatus::kNoAnswer;
}

Equilibrium::Slip Equilibrium::slip() const noexcept PALPATE_NONBLOCKING {
  const Vec3& f = contact_.coupled.response.force;
  Slip slip;
  slip.T = frame_.tangent.transpose() * f - perTip(energy_slope_);
  const double hold = law_.friction * std::max(0.0, -f.dot(frame_.normal));
  const double size = slip.T.norm();
  slip.excess = size - hold;
  slip.hold = size > 0.0 ? std::min(1.0, hold / size) : 1.0;
  slip.J = slope(slip);
  return slip;
}

/// A force on the anchor, work per length of its way, as one on the tip: the tip's way is (1 + R kappa) as long, taken as
/// a tenth where a tip of this radius can hardly roll or not at all (a hollow sharper than itself).
Vec2 Equilibrium::perTip(const Vec2& force) const noexcept PALPATE_NONBLOCKING {
  constexpr double kLeast = 0.1;
  const Mat2 stretch = frame_.tangent.transpose() * (frame_.along + tip_radius_ * frame_.turning);
  const SymmetricEigen<Mat2> eigen = symmetricEigen<Mat2>(0.5 * (stretch + stretch.transpose()));
  const Vec2 inverse(1.0 / std::max(eigen.values[0], kLeast), 1.0 / std::max(eigen.values[1], kLeast));
  return eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose() * force;
}

/// d(T - mu f_n T / |T|)/dxi. Where it is not stable (a ridge sharper than the tool's tip can ride on) the part that is.
Mat2 Equilibrium::slope(const Slip& slip) const noexcept PALPATE_NONBLOCKING {
  const Mat3& K = contact_.coupled.stiffness;
  const Vec3& n = frame_.normal;
  const Mat32 offset = frame_.along + tip_radius_ * frame_.turning;
  const double pressing = std::max(0.0, -contact_.coupled.response.force.dot(n));
  const Mat23 tangent = frame_.tangent.transpose();
  Mat2 J = -tangent * K * offset + pressing * tangent * frame_.turning;
  const Vec2 t = slip.T.norm() > 0.0 ? Vec2(slip.T.normalized()) : Vec2::Zero();
  const Eigen::RowVector2d normal_part = n.transpose() * K * offset;
  if (law_.friction > 0.0) J -= law_.friction * t * normal_part;
  if (isNegativeDefinite(J)) return J;
  const Mat2 plain = -tangent * K * frame_.tangent;
  return isNegativeDefinite(plain) ? plain : Mat2(-K.norm() * Mat2::Identity());
}

Vec2 Equilibrium::stepOf(const Slip& slip) noexcept PALPATE_NONBLOCKING {
  constexpr double kLongestStep = 2e-3;  // m
  const Vec2 step = -slip.J.inverse() * (slip.T * (slip.excess / slip.T.norm()));
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
  if (balance()) return !stayed;  // at the border the next step may lead back inside
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
  for (int i = 0; i < kMaxSlides && now.excess > kTolerance * response.force.norm() + kLeastForce; ++i) {
    if (i == 0) {
      giveWay(now);
      contact_.state = ContactState::kSlide;
    }
    const Vec2 step = stepOf(now);
    const Start start{contact_, frame_, energy_slope_};
    if (!slideBy(step) && ++stopped == 2) break;  // at the border: the first step may have gone too far
    const Slip next = landed(start, now, step);
    now = learned(next, start, now);
  }
  return true;
}

/// J does not know how dW/ds changes along the way; the last step shows it (Broyden's update, C. G. Broyden,
/// Math. Comp. 19 (1965) 577-593).
Equilibrium::Slip Equilibrium::learned(Slip next, const Start& start,
                                       const Slip& from) const noexcept PALPATE_NONBLOCKING {
  const Mat2 turn = frame_.tangent.transpose() * start.frame.tangent;
  const Vec2 way = frame_.tangent.transpose() * (frame_.position - start.frame.position);
  const auto goal = [](const Slip& slip) { return Vec2(slip.T * (slip.excess / slip.T.norm())); };
  const Vec2 missed = goal(next) - turn * goal(from) - next.J * way;
  const Mat2 J = next.J + missed * way.transpose() / way.squaredNorm();
  if (J.allFinite() && isNegativeDefinite(J)) next.J = J;
  return next;
}

/// A step that went past the cone, where friction would hold what did not move so far, is cut short: by the rule of
/// false position, to the edge of the cone.
Equilibrium::Slip Equilibrium::landed(const Start& start, const Slip& from,
                                      const Vec2& step) noexcept PALPATE_NONBLOCKING {
  constexpr int kMaxCuts = 4;
  constexpr double kInside = 1e-3;  // of |f|
  Slip now = slip();
  double share = 1.0;
  for (int i = 0; i < kMaxCuts && now.excess < -kInside * contact_.coupled.response.force.norm(); ++i) {
    share *= std::clamp(from.excess / (from.excess - now.excess), 0.1, 0.9);
    contact_ = start.contact;
    frame_ = start.frame;
    energy_slope_ = start.energy_slope;
    const bool moved = slideBy(share * step);
    now = slip();
    if (!moved) break;
  }
  return now;
}

/// dX/dc of an anchor that slides, as the law has it at the begin.
void Equilibrium::giveWay(const Slip& now) noexcept PALPATE_NONBLOCKING {
  const Mat3& K = contact_.coupled.stiffness;
  const Vec2 t = now.T.normalized();
  const Mat2 radial = Mat2::Identity() - now.hold * (Mat2::Identity() - t * t.transpose());
  const Eigen::RowVector3d normal_part = frame_.normal.transpose() * K;
  give_ = -frame_.tangent * now.J.inverse() *
          (radial * frame_.tangent.transpose() * K + law_.friction * t * normal_part);
  if (!give_.allFinite()) give_.setZero();
}

Mat3 Equilibrium::stiffness() const noexcept PALPATE_NONBLOCKING {
  const Mat3& K = contact_.coupled.stiffness;
  if (contact_.at_border) return K;
  return K - K * (frame_.along + tip_radius_ * frame_.turning) * frame_.tangent.transpose() * give_;
}

}  // namespace palpate
