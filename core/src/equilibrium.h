// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/core/contact_solver.h"
#include "palpate/core/coupling.h"
#include "palpate/core/meta_model.h"
#include "palpate/core/surface_mesh.h"

namespace palpate {

/// One contact at one tip position, while its anchor is being found.                  docs/design.md, Contact
///   g = c - X(s) - R n(s),   f = f(s, d) - df/dd e = K_vc (g - d),   T = f_t - (dW/ds) / (1 + R kappa),   f_n = -f . n
/// e the displacement of the patch that other tools cause; kappa the surface's curvature (a matrix): the tip goes
/// 1 + R kappa times as far as the anchor; t: along the surface, normal to n(s). Coulomb's law,
/// |T| <= mu f_n; the anchor gives way along T where it does not hold.
class Equilibrium {
 public:
  Equilibrium(const MetaModel& model, const ContactLaw& law, double tip_radius, const Vec3& c,
              Contact& contact) noexcept PALPATE_NONBLOCKING;

  /// d and f at the anchor as it is. @return false when the model has no answer there
  bool balance() noexcept PALPATE_NONBLOCKING;
  /// Moves the anchor until Coulomb's law holds, by at most kMaxSlides steps of Newton's method (where the anchor
  /// snaps from one balance to another, the next ticks go on):
  ///   ds = -J^-1 (|T| - mu f_n) T / |T|,   J = dT/ds with the coupled stiffness, offset and turning of the normal
  /// A step that goes past the cone is cut back, up to 4 times: 40 balances at most.
  /// @return false when the model has no answer at the begin; on the way the anchor stays where there was one
  bool slide() noexcept PALPATE_NONBLOCKING;
  /// d force / d c, of the force on the organ, N/m; how the anchor gives way as slide() had it at its begin.
  [[nodiscard]] Mat3 stiffness() const noexcept PALPATE_NONBLOCKING;
  static constexpr int kMaxSlides = 8;

 private:
  /// What the law says at the anchor.
  struct Slip {
    Vec2 T;              // tangential force that works in sliding, N
    double excess{0.0};  // |T| - mu f_n, N; above 0: it slides
    double hold{0.0};    // mu f_n / |T|, at most 1
    Mat2 J;              // d(excess T / |T|)/dxi, negative definite where sliding is stable, N/m
  };
  [[nodiscard]] Slip slip() const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] Vec2 perTip(const Vec2& force) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] Mat2 slope(const Slip& slip) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool slides() const noexcept PALPATE_NONBLOCKING;
  /// Where a step begins.
  struct Start {
    Contact contact;
    TangentFrame frame;
    Vec2 energy_slope;
  };
  [[nodiscard]] static Vec2 stepOf(const Slip& slip) noexcept PALPATE_NONBLOCKING;
  bool slideBy(const Vec2& step) noexcept PALPATE_NONBLOCKING;
  Slip landed(const Start& start, const Slip& from, const Vec2& step) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] Slip learned(Slip next, const Start& start,
                             const Slip& from) const noexcept PALPATE_NONBLOCKING;
  void giveWay(const Slip& now) noexcept PALPATE_NONBLOCKING;

  const MetaModel& model_;
  const ContactLaw& law_;
  double tip_radius_;
  Vec3 c_;
  Contact& contact_;
  TangentFrame frame_;
  Vec2 energy_slope_ = Vec2::Zero();  // dW/dxi at the anchor, N
  Mat3 give_ = Mat3::Zero();          // dX/dc of the anchor as it began to slide, 1
};

}  // namespace palpate
