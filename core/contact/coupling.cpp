// SPDX-License-Identifier: Apache-2.0
#include "core/contact/coupling.h"

#include <Eigen/LU>

namespace palpate {

namespace {

/// r(d) = d + (f(s, d) - df/dd e(d)) / K_vc - g, and the answer that it belongs to.
class Balance {
 public:
  Balance(const PatchResponse& patch, const Vec3& g, const Carried& carried,
          double compliance) noexcept PALPATE_NONBLOCKING : patch_(&patch),
                                                            g_(g),
                                                            carried_(carried),
                                                            compliance_(compliance) {}

  /// Evaluates at d. @return whether the organ has an answer
  bool moveTo(const Vec3& d, Budget& budget) noexcept PALPATE_NONBLOCKING {
    displacement = d;
    status = patch_->at(d, budget, response);
    response.force -= response.stiffness * carried_.at(d);
    response.stiffness -= (response.stiffness * carried_.slope).eval();
    residual = d + compliance_ * response.force - g_;
    return status != ResponseStatus::kNoAnswer;
  }
  [[nodiscard]] Mat3 slope() const noexcept PALPATE_NONBLOCKING {
    return Mat3::Identity() + compliance_ * response.stiffness;
  }

  Vec3 displacement = Vec3::Zero();
  Vec3 residual = Vec3::Zero();  // m
  Response response;
  ResponseStatus status{ResponseStatus::kOk};

 private:
  const PatchResponse* patch_;
  Vec3 g_;
  Carried carried_;
  double compliance_;
};

/// One Newton step, halved until the residual falls. An answer that is cut short does not count.
/// @return false when it does not fall
bool improve(Balance& balance, Budget& budget) noexcept PALPATE_NONBLOCKING {
  constexpr int kMaxHalvings = 4;
  const Balance before = balance;
  Vec3 step = before.slope().inverse() * before.residual;
  for (int halving = 0; halving <= kMaxHalvings && budget.allows(); ++halving, step *= 0.5) {
    balance.moveTo(before.displacement - step, budget);
    if (!budget.cut() && balance.residual.norm() < before.residual.norm()) return true;
  }
  balance = before;
  return false;
}

}  // namespace

ResponseStatus couple(const PatchResponse& patch, const Vec3& g, const Carried& carried,
                      const ContactLaw& law, Budget& budget,
                      CoupledResponse& out) noexcept PALPATE_NONBLOCKING {
  constexpr int kMaxSteps = 8;
  constexpr double kTolerance = 1e-9;  // of |g|
  const double compliance = law.compliance * law.stiffness_scale;
  Balance balance(patch, g, carried, compliance);
  balance.moveTo(compliance > 0.0 ? out.displacement : g, budget);
  if (budget.cut()) return balance.status;
  if (compliance > 0.0)
    for (int i = 0; i < kMaxSteps && balance.residual.norm() > kTolerance * g.norm(); ++i)
      if (!improve(balance, budget)) break;
  out.displacement = balance.displacement;
  out.response = balance.response;
  out.response.force *= law.stiffness_scale;
  out.response.stiffness *= law.stiffness_scale;
  out.stiffness = out.response.stiffness;
  if (compliance > 0.0) out.stiffness = (out.response.stiffness * balance.slope().inverse()).eval();
  return balance.status;
}

}  // namespace palpate
