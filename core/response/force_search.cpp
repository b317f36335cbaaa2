// SPDX-License-Identifier: Apache-2.0
#include "core/response/force_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/length.h"
#include "core/model/clamp_to_length.h"

namespace palpate {

namespace {

/// Of the symmetric part, by its leading minors; false for NaN.
bool isPositiveDefinite(const Mat3& A) noexcept PALPATE_NONBLOCKING {
  const Mat3 S = 0.5 * (A + A.transpose());
  return S(0, 0) > 0.0 && S.topLeftCorner<2, 2>().determinant() > 0.0 && S.determinant() > 0.0;
}

/// Newton on d(f) = d, over all f: beyond the domain d(f) is continued with degree 1, so that it has one
/// solution for each direction of d if it has one at the domain's edge.
class ForceSearch {
 public:
  ForceSearch(const ContactSeries& series, Budget& budget) noexcept PALPATE_NONBLOCKING
      : series_(series),
        budget_(budget),
        at_rest_(series.gradient(Vec3::Zero()).inverse()) {}

  /// False when the model has no answer to a small d.
  [[nodiscard]] bool valid() const noexcept PALPATE_NONBLOCKING { return at_rest_.allFinite(); }
  /// f with d(f) = d, on a branch with a positive definite dd/df. @return false when f is only what comes nearest
  [[nodiscard]] bool find(const Vec3& d, Vec3& f) noexcept PALPATE_NONBLOCKING;
  /// Derivative of the continued d(f).
  [[nodiscard]] Mat3 gradient(const Vec3& f) noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] bool beyond(const Vec3& f) const noexcept PALPATE_NONBLOCKING {
    return f.norm() > series_.limit();
  }
  [[nodiscard]] Vec3 value(const Vec3& f) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool newton(const Vec3& d, Vec3& f) noexcept PALPATE_NONBLOCKING;
  void descend(const Vec3& d, Vec3& f) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool improve(const Vec3& d, Vec3& f, Vec3& residual) noexcept PALPATE_NONBLOCKING;

  const ContactSeries& series_;
  Budget& budget_;
  Mat3 at_rest_;  // df/dd at f = 0
};

Vec3 ForceSearch::value(const Vec3& f) noexcept PALPATE_NONBLOCKING {
  budget_.spend(1);
  if (!beyond(f)) return series_.value(f);
  return series_.value(clampToLength(f, series_.limit())) * (f.norm() / series_.limit());
}

Mat3 ForceSearch::gradient(const Vec3& f) noexcept PALPATE_NONBLOCKING {
  budget_.spend(1);
  if (!beyond(f)) return series_.gradient(f);
  const Vec3 edge = clampToLength(f, series_.limit()), e = edge / series_.limit();
  const Mat3 across = Mat3::Identity() - e * e.transpose();
  return series_.value(edge) * e.transpose() / series_.limit() + series_.gradient(edge) * across;
}

/// One step, halved until the residual falls. @return false when it does not
bool ForceSearch::improve(const Vec3& d, Vec3& f, Vec3& residual) noexcept PALPATE_NONBLOCKING {
  constexpr int kMaxHalvings = 5;
  Vec3 step = gradient(f).inverse() * residual;
  for (int halving = 0; halving <= kMaxHalvings; ++halving, step *= 0.5) {
    const Vec3 next = f - step, left = value(next) - d;
    if (!(left.norm() < residual.norm())) continue;  // true for NaN too
    f = next;
    residual = left;
    return true;
  }
  return false;
}

bool ForceSearch::newton(const Vec3& d, Vec3& f) noexcept PALPATE_NONBLOCKING {
  constexpr int kMaxIterations = 12;
  constexpr double kTolerance = 1e-11;  // of |d|
  Vec3 residual = value(f) - d;
  for (int i = 0; i < kMaxIterations; ++i) {
    if (residual.norm() <= kTolerance * d.norm()) return true;
    if (!budget_.allows() || !improve(d, f, residual)) return false;
  }
  return residual.norm() <= kTolerance * d.norm();
}

/// From f = 0, so that of several branches that of small forces is found.
void ForceSearch::descend(const Vec3& d, Vec3& f) noexcept PALPATE_NONBLOCKING {
  constexpr int kSteps = 30;
  constexpr double kFirst = 1e-3, kLeast = 1e-12;  // damping, of the diagonal
  constexpr double kFloor = 1e-6;                  // of the trace: keeps a singular matrix away
  constexpr double kClose = 1e-12;                 // of |d|
  f.setZero();
  Vec3 residual = -d;
  double damping = kFirst;
  const double close = kClose * d.norm();
  for (int i = 0; i < kSteps && !(residual.norm() <= close) && budget_.allows(); ++i) {
    const Mat3 J = gradient(f);
    Mat3 A = J.transpose() * J;
    A.diagonal() += damping * (A.diagonal() + Vec3::Constant(kFloor * A.trace()));
    const Vec3 next = f - A.inverse() * (J.transpose() * residual), left = value(next) - d;
    const bool better = left.norm() < residual.norm();  // false for NaN
    damping = better ? std::max(kLeast, 0.1 * damping) : 10.0 * damping;
    if (better) f = next, residual = left;
  }
}

bool ForceSearch::find(const Vec3& d, Vec3& f) noexcept PALPATE_NONBLOCKING {
  constexpr double kTolerance = 1e-9;  // of |d|
  f = at_rest_ * d;
  if (newton(d, f) && isPositiveDefinite(gradient(f))) return true;
  if (!budget_.allows()) return false;
  descend(d, f);
  return (value(f) - d).norm() <= kTolerance * d.norm() && isPositiveDefinite(gradient(f));
}

/// |d| where the ray of f leaves the domain; at rest, where there is no ray, a length that is inside of it.
double radiusAlong(const ContactSeries& series, const Vec3& f,
                   const Mat3& stiffness) noexcept PALPATE_NONBLOCKING {
  if (lengthOf(f) > 0.0) return series.value((series.limit() / lengthOf(f)) * f).norm();
  return stiffness == Mat3::Zero() ? 0.0 : series.limit() / stiffness.norm();
}

ResponseStatus noNumber(Response& out) noexcept PALPATE_NONBLOCKING {
  out = Response{};
  out.force.setConstant(std::numeric_limits<double>::quiet_NaN());
  return ResponseStatus::kBeyond;
}

}  // namespace

ResponseStatus checked(ResponseStatus status, Response& out) noexcept PALPATE_NONBLOCKING {
  const bool good = out.force.allFinite() && out.stiffness.allFinite() && out.displacement.allFinite() &&
                    std::isfinite(out.domain_radius);
  return good ? status : noNumber(out);
}

ResponseStatus answerToForce(const ContactSeries& series, const Vec3& f,
                             Response& out) noexcept PALPATE_NONBLOCKING {
  out.force = clampToLength(f, series.limit());
  out.parameter = out.force;
  out.displacement = series.value(out.force);
  const Mat3 compliance = series.gradient(out.force);
  out.stiffness.setZero();
  if (isPositiveDefinite(compliance)) out.stiffness = compliance.inverse();
  out.domain_radius = radiusAlong(series, out.force, out.stiffness);
  return checked(lengthOf(f) > series.limit() ? ResponseStatus::kBeyond : ResponseStatus::kOk, out);
}

ResponseStatus findForce(const ContactSeries& series, const Vec3& d, Budget& budget,
                         Response& out) noexcept PALPATE_NONBLOCKING {
  constexpr double kFar = 1e3;       // m; beyond every domain, and its square is finite
  constexpr int kRestAndAnswer = 4;  // evaluations
  const Vec3 target = clampToLength(d, kFar);
  ForceSearch search(series, budget);
  budget.spend(kRestAndAnswer);
  if (!search.valid()) return noNumber(out);
  Vec3 f = Vec3::Zero();
  const bool found = search.find(target, f);
  const ResponseStatus status = answerToForce(series, f, out);
  if (!found) {  // the force stays where nothing comes nearer
    out.stiffness.setZero();
    out.domain_radius = out.displacement.norm();
    return ResponseStatus::kBeyond;
  }
  if (status == ResponseStatus::kOk || !out.force.allFinite()) return status;
  const Mat3 projection = projectionGradient(f, series.limit());
  out.stiffness = projection * search.gradient(f).inverse() * (target.norm() / lengthOf(d));
  return checked(status, out);
}

}  // namespace palpate
