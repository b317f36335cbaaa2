// SPDX-License-Identifier: Apache-2.0
#include "core/devices/path/path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace palpate::device {

Point operator+(const Point& a, const Point& b) noexcept PALPATE_NONBLOCKING {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Point operator-(const Point& a, const Point& b) noexcept PALPATE_NONBLOCKING {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point operator*(double factor, const Point& a) noexcept PALPATE_NONBLOCKING {
  return {factor * a[0], factor * a[1], factor * a[2]};
}
double dot(const Point& a, const Point& b) noexcept PALPATE_NONBLOCKING {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double length(const Point& a) noexcept PALPATE_NONBLOCKING {
  return std::sqrt(dot(a, a));
}

Point tangentOf(const Point& normal) noexcept {
  const Point axis = std::abs(normal[0]) < 0.9 ? Point{1.0, 0.0, 0.0} : Point{0.0, 1.0, 0.0};
  const Point along = axis - dot(axis, normal) * normal;
  return (1.0 / length(along)) * along;
}

double minimumJerk(double x) noexcept PALPATE_NONBLOCKING {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
}

Path::Path(const Point& start, std::vector<Leg> legs) : start_(start), legs_(std::move(legs)) {
  if (legs_.empty()) throw std::invalid_argument("a path needs at least one leg");
  double end = 0.0;
  for (const Leg& leg : legs_) {
    if (!(leg.seconds > 0.0))
      throw std::invalid_argument("leg '" + leg.name + "' takes " + std::to_string(leg.seconds) +
                                  " s, expected above 0");
    ends_.push_back(end += leg.seconds);
  }
}

std::size_t Path::indexAt(double t) const noexcept PALPATE_NONBLOCKING {
  const auto found = std::upper_bound(ends_.begin(), ends_.end(), t);
  return std::min(static_cast<std::size_t>(found - ends_.begin()), legs_.size() - 1);
}

Point Path::at(double t) const noexcept PALPATE_NONBLOCKING {
  const std::size_t i = indexAt(t);
  const Point& from = i == 0 ? start_ : legs_[i - 1].target;
  const double x = (t - (ends_[i] - legs_[i].seconds)) / legs_[i].seconds;
  return from + minimumJerk(x) * (legs_[i].target - from);
}

const std::string& Path::legAt(double t) const noexcept PALPATE_NONBLOCKING {
  return legs_[indexAt(t)].name;
}

Path Path::stretchedTo(double seconds) const {
  std::vector<Leg> legs = legs_;
  for (Leg& leg : legs) leg.seconds *= seconds / this->seconds();
  return Path(start_, std::move(legs));
}

}  // namespace palpate::device
