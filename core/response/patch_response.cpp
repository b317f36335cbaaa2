// SPDX-License-Identifier: Apache-2.0
#include "core/response/patch_response.h"

#include <algorithm>
#include <array>

#include "core/base/length.h"
#include "core/base/symmetric_eigen.h"
#include "core/model/clamp_to_length.h"
#include "core/response/force_search.h"
#include "core/response/level_search.h"

namespace palpate {

namespace {

/// The part of the symmetrized K that pushes back: its negative eigenvalues set to zero.
class PushingPart {
 public:
  explicit PushingPart(const Mat3& K) noexcept PALPATE_NONBLOCKING {
    const SymmetricEigen<Mat3> eigen = symmetricEigen<Mat3>(0.5 * (K + K.transpose()));
    vectors_ = eigen.vectors;
    values_ = eigen.values;
  }
  [[nodiscard]] Mat3 matrix() const noexcept PALPATE_NONBLOCKING {
    Vec3 pushing;
    for (Eigen::Index i = 0; i < 3; ++i) pushing[i] = std::max(values_[i], 0.0);
    return vectors_ * pushing.asDiagonal() * vectors_.transpose();
  }
  /// How it changes when K does so by dK: between eigenvectors i and j by (l_i+ - l_j+) / (l_i - l_j) of that, the
  /// divided difference (Daleckii and Krein; R. Bhatia, Matrix Analysis, 1997, theorem V.3.3).
  [[nodiscard]] Mat3 change(const Mat3& dK) const noexcept PALPATE_NONBLOCKING {
    Mat3 seen = vectors_.transpose() * (0.5 * (dK + dK.transpose())) * vectors_;
    for (Eigen::Index i = 0; i < 3; ++i)
      for (Eigen::Index j = 0; j < 3; ++j) seen(i, j) *= share(values_[i], values_[j]);
    return vectors_ * seen * vectors_.transpose();
  }

 private:
  [[nodiscard]] static double share(double a, double b) noexcept PALPATE_NONBLOCKING {
    const double high = std::max(a, b), low = std::min(a, b);
    return high > 0.0 ? (low > 0.0 ? 1.0 : high / (high - low)) : 0.0;
  }

  Mat3 vectors_;
  Vec3 values_;
};

/// Force and its derivative where the polynomials end, |d| > r_max:
///   f = f(e) + P(e) (d - e),   df/dd = P + (K + B - P) de/dd,   B_j = dP/de_j (d - e)
/// e the point of that edge towards d, K = df/dd there, P its pushing part.
void continueTo(const ContactSeries& series, const Vec3& d, Response& out) noexcept PALPATE_NONBLOCKING {
  const Vec3 edge = clampToLength(d, series.limit()), beyond = d - edge;
  std::array<Mat3, 3> turn;
  Mat3 K;
  series.evaluate(edge, out.force, K, turn);
  const PushingPart pushing(K);
  const Mat3 P = pushing.matrix();
  out.force += P * beyond;
  Mat3 B;
  for (Eigen::Index j = 0; j < 3; ++j) B.col(j) = pushing.change(turn[static_cast<std::size_t>(j)]) * beyond;
  out.stiffness = P + (K + B - P) * projectionGradient(d, series.limit());
}

/// f(s, d) of a "displacement" model.
ResponseStatus answerToDisplacement(const ContactSeries& series, const Vec3& d, Budget& budget,
                                    Response& out) noexcept PALPATE_NONBLOCKING {
  constexpr double kFar = 1e3;                // m; beyond every domain, and what follows is finite
  constexpr int kInside = 1, kContinued = 4;  // evaluations; second derivatives and eigenvalues cost more
  out.domain_radius = series.domainRadius();
  out.series_radius = series.limit();
  out.shown_radius = kShownRadii * out.series_radius;
  out.displacement = clampToLength(d, out.shown_radius);
  out.parameter = out.displacement;
  const double length = lengthOf(d);
  if (length > out.series_radius) {
    budget.spend(kContinued);
    continueTo(series, clampToLength(d, kFar), out);
  } else {
    budget.spend(kInside);
    series.evaluate(d, out.force, out.stiffness);
  }
  return length > out.domain_radius ? ResponseStatus::kBeyond : ResponseStatus::kOk;
}

/// Loads are mixed linearly: what is mixed there is not the derivative of an energy.
ContactSeries seriesAt(const MetaModel& model, const ContactPoint& s, const Stencil& stencil,
                       const Mat3& stiffness) noexcept PALPATE_NONBLOCKING {
  const PositionMix mix = model.surface().mix(s);
  if (!model.isDisplacementDriven()) return model.response().at(mix);
  return model.response().at(stencil, stiffness, mix);
}

PatchStiffness::Value stiffnessAt(const MetaModel& model,
                                  const ContactPoint& s) noexcept PALPATE_NONBLOCKING {
  PatchStiffness::Value value;
  if (model.isDisplacementDriven()) model.stiffness().at(model.surface(), s, value);
  return value;
}

}  // namespace

PatchResponse::PatchResponse(const MetaModel& model, const ContactPoint& s) noexcept PALPATE_NONBLOCKING
    : model_(model),
      stencil_(model.mixing().at(model.surface(), s)),
      stiffness_(stiffnessAt(model, s)),
      series_(seriesAt(model, s, stencil_, stiffness_.K)) {}

Vec3 PatchResponse::energySlope(const Vec3& d) const noexcept PALPATE_NONBLOCKING {
  if (!model_.isDisplacementDriven()) return Vec3::Zero();
  return model_.response().energySlope(stencil_, stiffness_.slope, d, series_.limit());
}

double PatchResponse::energy(const Vec3& d) const noexcept PALPATE_NONBLOCKING {
  return model_.isDisplacementDriven() ? series_.energy(d) : 0.0;
}

ResponseStatus PatchResponse::at(const Vec3& d, Response& out) const noexcept PALPATE_NONBLOCKING {
  Budget endless = Budget::endless();
  return at(d, endless, out);
}

ResponseStatus PatchResponse::at(const Vec3& d, Budget& budget,
                                 Response& out) const noexcept PALPATE_NONBLOCKING {
  constexpr int kLevelSearch = 20;  // evaluations, at most
  out = Response{};
  if (stencil_.count == 0) return ResponseStatus::kNoAnswer;
  const Parameters parameters = model_.attributes().parameters;
  if (parameters == Parameters::kDisplacement) return answerToDisplacement(series_, d, budget, out);
  if (parameters == Parameters::kLevel) budget.spend(kLevelSearch);
  const ResponseStatus status = parameters == Parameters::kForce
                                    ? findForce(series_, d, budget, out)
                                    : findLevel(series_, model_.attributes(), d, out);
  out.series_radius = out.shown_radius = out.domain_radius;
  return status;
}

ResponseStatus respond(const MetaModel& model, const ContactPoint& s, const Vec3& d,
                       Response& out) noexcept PALPATE_NONBLOCKING {
  return PatchResponse(model, s).at(d, out);
}

ResponseStatus respondToLoad(const MetaModel& model, const ContactPoint& s, const Vec3& load,
                             Response& out) noexcept PALPATE_NONBLOCKING {
  out = Response{};
  const PositionMix mix = model.surface().mix(s);
  const Parameters parameters = model.attributes().parameters;
  if (mix.count == 0 || parameters == Parameters::kDisplacement) return ResponseStatus::kNoAnswer;
  const ContactSeries series = model.response().at(mix);
  const ResponseStatus status = parameters == Parameters::kForce
                                    ? answerToForce(series, load, out)
                                    : answerToLevel(series, model.attributes(), load.x(), out);
  out.series_radius = out.shown_radius = out.domain_radius;
  return status;
}

void evaluateField(const MetaModel& model, const ContactPoint& s, const Vec3& d, FieldScratch& scratch,
                   std::span<float> u) noexcept PALPATE_NONBLOCKING {
  Response response;
  (void)respond(model, s, d, response);  // without an answer there is no field either
  const std::array<FieldSource, 1> source{FieldSource{s, response.parameter, 1.0}};
  evaluateField(model, source, scratch, u);
}

}  // namespace palpate
