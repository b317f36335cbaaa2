// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>

#include "load_driven.h"

namespace palpate {

namespace {

/// Newton on d(f) = d, over all f: beyond the domain d(f) is continued with degree 1, so that it has one
/// solution for each direction of d if it has one at the domain's edge.
class ForceSearch {
 public:
  explicit ForceSearch(const ContactSeries& series) noexcept
      : series_(series), at_rest_(series.gradient(Vec3::Zero()).inverse()) {}

  /// f of the largest share of d that is reached. @return the share: 1, or the last of 32nds that converged
  [[nodiscard]] double reach(const Vec3& d, Vec3& f) const noexcept;
  /// Derivative of the continued d(f).
  [[nodiscard]] Mat3 gradient(const Vec3& f) const noexcept;

 private:
  [[nodiscard]] bool beyond(const Vec3& f) const noexcept { return f.norm() > series_.limit(); }
  [[nodiscard]] Vec3 value(const Vec3& f) const noexcept;
  [[nodiscard]] bool newton(const Vec3& d, Vec3& f) const noexcept;
  [[nodiscard]] bool improve(const Vec3& d, Vec3& f, Vec3& residual) const noexcept;

  const ContactSeries& series_;
  Mat3 at_rest_;  // df/dd at f = 0
};

Vec3 ForceSearch::value(const Vec3& f) const noexcept {
  if (!beyond(f)) return series_.value(f);
  return series_.value(clampToDomain(f, series_.limit())) * (f.norm() / series_.limit());
}

Mat3 ForceSearch::gradient(const Vec3& f) const noexcept {
  if (!beyond(f)) return series_.gradient(f);
  const Vec3 edge = clampToDomain(f, series_.limit()), e = edge / series_.limit();
  const Mat3 across = Mat3::Identity() - e * e.transpose();
  return series_.value(edge) * e.transpose() / series_.limit() + series_.gradient(edge) * across;
}

/// One step, halved until the residual falls. @return false when it does not
bool ForceSearch::improve(const Vec3& d, Vec3& f, Vec3& residual) const noexcept {
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

bool ForceSearch::newton(const Vec3& d, Vec3& f) const noexcept {
  constexpr int kMaxIterations = 12;
  constexpr double kTolerance = 1e-11;  // of |d|
  Vec3 residual = value(f) - d;
  for (int i = 0; i < kMaxIterations; ++i) {
    if (residual.norm() <= kTolerance * d.norm()) return true;
    if (!improve(d, f, residual)) return false;
  }
  return residual.norm() <= kTolerance * d.norm();
}

double ForceSearch::reach(const Vec3& d, Vec3& f) const noexcept {
  constexpr int kHalvings = 5;
  f = at_rest_ * d;
  if (newton(d, f)) return 1.0;
  double reached = 0.0, missed = 1.0;
  f.setZero();
  for (int i = 0; i < kHalvings; ++i) {
    const double share = 0.5 * (reached + missed);
    Vec3 trial = reached > 0.0 ? Vec3(f * (share / reached)) : Vec3(at_rest_ * (share * d));
    const bool good = newton(share * d, trial);
    (good ? reached : missed) = share;
    if (good) f = trial;
  }
  return reached;
}

/// |d| where the ray of f leaves the domain; at rest, where there is no ray, a length that is inside of it.
double radiusAlong(const ContactSeries& series, const Vec3& f, const Mat3& stiffness) noexcept {
  if (f.norm() > 0.0) return series.value(f.stableNormalized() * series.limit()).norm();
  return series.limit() / stiffness.norm();
}

/// What a model answers whose numbers overflow, or have no inverse.
ResponseStatus checked(ResponseStatus status, Response& out) noexcept {
  if (out.force.allFinite() && out.stiffness.allFinite() && out.displacement.allFinite()) return status;
  out = Response{};
  return ResponseStatus::kClamped;
}

}  // namespace

ResponseStatus answerToForce(const ContactSeries& series, const Vec3& f,
                             Response& out) noexcept PALPATE_NONBLOCKING {
  out.force = clampToDomain(f, series.limit());
  out.parameter = out.force;
  out.displacement = series.value(out.force);
  out.stiffness = series.gradient(out.force).inverse();
  out.domain_radius = radiusAlong(series, out.force, out.stiffness);
  return checked(f.stableNorm() > series.limit() ? ResponseStatus::kClamped : ResponseStatus::kOk, out);
}

ResponseStatus findForce(const ContactSeries& series, const Vec3& d,
                         Response& out) noexcept PALPATE_NONBLOCKING {
  constexpr double kFar = 1e3;  // m; beyond every domain, and its square is finite
  const Vec3 target = clampToDomain(d, kFar);
  const ForceSearch search(series);
  Vec3 f = Vec3::Zero();
  const double share = search.reach(target, f);
  const ResponseStatus status = answerToForce(series, f, out);
  if (share < 1.0) {  // the force stays where Newton stopped
    out.stiffness.setZero();
    out.domain_radius = out.displacement.norm();
    return ResponseStatus::kClamped;
  }
  if (status == ResponseStatus::kOk) return status;
  const Mat3 projection = projectionGradient(f, series.limit());
  out.stiffness = projection * search.gradient(f).inverse() * (target.norm() / d.stableNorm());
  return checked(status, out);
}

}  // namespace palpate
