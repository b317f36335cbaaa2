// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "core/base/budget.h"
#include "core/contact/contact.h"
#include "core/contact/coupling.h"
#include "core/contact/friction_flow.h"
#include "core/model/meta_model.h"
#include "core/response/patch_response.h"
#include "core/surface/surface_mesh.h"

namespace palpate {

/// One contact at one tip position, while its anchor is being found.                  docs/design.md, Contact
///   g = c - X(s) - R n(s),   f = f(s, d) - df/dd e = K_vc (g - d),   T = f_t - (dE/ds) / (1 + R kappa),   f_n = -f . n
/// e the displacement of the patch that other tools cause; E(s, d) = W - f(s, d) . e + e . df/dd e / 2 of the energy W(s, d), so
/// that dE/ds knows e(s) too (without other tools dW/ds); kappa the surface's curvature (a matrix): the tip goes
/// 1 + R kappa times as far as the anchor; t: along the surface, normal to n(s). Coulomb's law: |T| <= mu f_n, and where
/// the anchor gives way, T opposes the tip's way (wayAgainst()). An anchor that goes much farther than its tip snaps from
/// one balance to another: beyond kFreeWay times the tip's way viscosity holds it back, kViscousSpeed costs one f_n.
class Equilibrium {
 public:
  Equilibrium(const MetaModel& model, const ContactLaw& law, double tip_radius, const Vec3& c, Budget& budget,
              Contact& contact) noexcept PALPATE_NONBLOCKING;

  /// d and f at the anchor as it is. @return false when the model has no answer there
  bool balance() noexcept PALPATE_NONBLOCKING;
  /// Moves the anchor until Coulomb's law holds, by at most kMaxSlides steps of Newton's method, 9 balances. Where an
  /// anchor snaps, the next ticks go on; where the budget ends before, the anchor is at its last balance.
  /// @return false when the model has no answer at the begin; on the way the anchor stays where there was one
  bool slide() noexcept PALPATE_NONBLOCKING;
  /// d force / d c, of the force on the organ, N/m; with how the anchor gives way.
  [[nodiscard]] Mat3 stiffness() const noexcept PALPATE_NONBLOCKING;
  static constexpr int kMaxSlides = 8;

 private:
  static constexpr double kFreeWay = 2.0;        // of the tip's way; the surface and d seldom ask for more
  static constexpr double kViscousSpeed = 0.25;  // m/s
  /// What the law says at the anchor. Forces and ways along the tangents, of the tip.
  struct Slip {
    Vec2 T;           // tangential force that works in sliding, N
    Vec2 way;         // of the tip's place at d = 0, since the tick's begin, m
    Mat2 A;           // -dT/dway, positive definite where sliding is stable, N/m
    Mat2 per_tip;     // the anchor's way over the tip's
    Holding holding;  // what holds the tip back
  };
  [[nodiscard]] Vec2 energySlope(const PatchResponse& patch,
                                 const Carried& carried) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] Vec3 ownEnergySlope(const PatchResponse& patch,
                                    const Carried& carried) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] Slip slip() const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] static Vec2 missing(const Slip& slip) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] static Mat2 inverseStretch(const Mat2& stretch) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] Mat2 stiffnessAgainst(double pressing,
                                      const Mat2& per_tip) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] Vec3 touching() const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool slides() const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] static Vec2 stepOf(const Slip& slip) noexcept PALPATE_NONBLOCKING;
  bool slideBy(const Vec2& step) noexcept PALPATE_NONBLOCKING;
  /// @param frame, from  of the place before
  [[nodiscard]] Slip learned(Slip next, const TangentFrame& frame,
                             const Slip& from) const noexcept PALPATE_NONBLOCKING;
  void giveWay(const Slip& now) noexcept PALPATE_NONBLOCKING;

  const MetaModel& model_;
  const ContactLaw& law_;
  double tip_radius_;
  Vec3 c_;
  Budget& budget_;
  Contact& contact_;
  TangentFrame frame_;
  Vec3 begin_;                                                // the tip's place at d = 0 as the tick began, m
  double free_way_{std::numeric_limits<double>::infinity()};  // m; of a capture, none is too long
  Vec2 energy_slope_ = Vec2::Zero();                          // dE/dxi at the anchor, N
  Mat3 give_ = Mat3::Zero();                                  // dX/dc of the anchor, 1
};

}  // namespace palpate
