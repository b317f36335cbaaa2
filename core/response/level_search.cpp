// SPDX-License-Identifier: Apache-2.0
#include "core/response/level_search.h"

#include <algorithm>
#include <cmath>

#include "core/response/force_search.h"

namespace palpate {

namespace {

/// A piece of the piecewise linear g(t) = e . d(s, t), from the step `first` to the step `last`.
struct Bracket {
  int first{0};
  int last{0};
  double below{0.0};  ///< g at its beginning
  double above{0.0};  ///< g at its end
};

/// e . d(s, t) over the steps of the level, the last one cut off at t_max.
class LevelSearch {
 public:
  LevelSearch(const ContactSeries& series, const Vec3& direction) noexcept PALPATE_NONBLOCKING
      : series_(series),
        direction_(direction),
        last_(lastStep(series.limit(), series.levelSteps())) {}

  [[nodiscard]] double along(double t) const noexcept PALPATE_NONBLOCKING {
    return direction_.dot(series_.value({t, 0.0, 0.0}));
  }
  /// The level with g = wanted; 0 < wanted <= g(t_max). @param[out] slope  dg/dt there, m
  [[nodiscard]] double find(double wanted, double& slope) const noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] double level(int step) const noexcept PALPATE_NONBLOCKING {
    return step == last_ ? series_.limit() : double(step) / series_.levelSteps();
  }

  const ContactSeries& series_;
  const Vec3& direction_;
  int last_;
};

double LevelSearch::find(double wanted, double& slope) const noexcept PALPATE_NONBLOCKING {
  Bracket in{0, last_, 0.0, along(series_.limit())};
  while (in.last - in.first > 1) {  // at most 17 times: L <= 100000
    const int middle = (in.first + in.last) / 2;
    const double g = along(level(middle));
    (g < wanted ? in.first : in.last) = middle;
    (g < wanted ? in.below : in.above) = g;
  }
  const double begin = level(in.first), end = level(in.last);
  slope = (in.above - in.below) / (end - begin);
  return std::min(begin + (wanted - in.below) / slope, end);
}

Vec3 directionOf(const ModelAttributes& attributes) noexcept PALPATE_NONBLOCKING {
  return Eigen::Map<const Vec3>(attributes.load_direction.data());
}

/// Force, displacement and radius at a level inside the domain; stiffness for dg/dt > 0, else zero.
ResponseStatus settle(const ContactSeries& series, const ModelAttributes& attributes, double t, double slope,
                      ResponseStatus status, Response& out) noexcept PALPATE_NONBLOCKING {
  const Vec3 e = directionOf(attributes);
  out.parameter = {t, 0.0, 0.0};
  out.force = t * attributes.load * e;
  out.displacement = series.value(out.parameter);
  out.domain_radius = series.value({series.limit(), 0.0, 0.0}).norm();
  out.stiffness.setZero();
  if (slope > 0.0) out.stiffness = attributes.load / slope * e * e.transpose();
  return checked(status, out);
}

}  // namespace

ResponseStatus answerToLevel(const ContactSeries& series, const ModelAttributes& attributes, double t,
                             Response& out) noexcept PALPATE_NONBLOCKING {
  const double used = t > 0.0 ? std::min(t, series.limit()) : 0.0;  // NaN is at rest
  const double slope = directionOf(attributes).dot(series.gradient({used, 0.0, 0.0}).col(0));
  const ResponseStatus status = used == t ? ResponseStatus::kOk : ResponseStatus::kBeyond;
  return settle(series, attributes, used, slope, status, out);
}

ResponseStatus findLevel(const ContactSeries& series, const ModelAttributes& attributes, const Vec3& d,
                         Response& out) noexcept PALPATE_NONBLOCKING {
  const Vec3 e = directionOf(attributes);
  const LevelSearch search(series, e);
  const double wanted = e.dot(d);
  if (d == Vec3::Zero()) return answerToLevel(series, attributes, 0.0, out);
  if (!(wanted > 0.0)) return settle(series, attributes, 0.0, 0.0, ResponseStatus::kBeyond, out);
  if (!(wanted <= search.along(series.limit())))
    return settle(series, attributes, series.limit(), 0.0, ResponseStatus::kBeyond, out);
  double slope = 0.0;
  const double t = search.find(wanted, slope);
  return settle(series, attributes, t, slope, ResponseStatus::kOk, out);
}

}  // namespace palpate
