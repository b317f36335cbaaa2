// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

namespace palpate::device {

/// x, y, z in world frame W, m; or a direction, 1. A type of its own, so that lookup finds the operators below.
struct Point : std::array<double, 3> {};

[[nodiscard]] Point operator+(const Point& a, const Point& b) noexcept PALPATE_NONBLOCKING;
[[nodiscard]] Point operator-(const Point& a, const Point& b) noexcept PALPATE_NONBLOCKING;
[[nodiscard]] Point operator*(double factor, const Point& a) noexcept PALPATE_NONBLOCKING;
[[nodiscard]] double dot(const Point& a, const Point& b) noexcept PALPATE_NONBLOCKING;
[[nodiscard]] double length(const Point& a) noexcept PALPATE_NONBLOCKING;

/// A unit direction along the surface: the one nearest to +x, or to +y where x is the normal.
/// @param[in] normal  unit length
[[nodiscard]] Point tangentOf(const Point& normal) noexcept;

/// The minimum-jerk profile 10 x^3 - 15 x^4 + 6 x^5: from 0 to 1 with velocity and acceleration zero at both
/// ends (T. Flash, N. Hogan, J. Neurosci. 5 (1985) 1688-1703). @param[in] x  clamped to [0, 1]
[[nodiscard]] double minimumJerk(double x) noexcept PALPATE_NONBLOCKING;

/// One leg of a path.
struct Leg {
  Point target;    ///< where it ends, m
  double seconds;  ///< its duration, above 0; a leg that ends where it starts is a pause
  std::string name;
};

/// A smooth path through space: straight minimum-jerk legs that stop at each target.
class Path {
 public:
  Path(const Point& start, std::vector<Leg> legs);

  /// @param[in] t  s since the start; before 0 the start, after seconds() the last target
  /// Real-time: yes. Threads: any.
  [[nodiscard]] Point at(double t) const noexcept PALPATE_NONBLOCKING;
  /// Name of the leg at time t. Real-time: yes.
  [[nodiscard]] const std::string& legAt(double t) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] double seconds() const noexcept { return ends_.back(); }

  /// The same path in another duration.
  /// @param[in] seconds  above 0
  [[nodiscard]] Path stretchedTo(double seconds) const;

 private:
  [[nodiscard]] std::size_t indexAt(double t) const noexcept PALPATE_NONBLOCKING;

  Point start_;
  std::vector<Leg> legs_;
  std::vector<double> ends_;  // s, when each leg ends
};

}  // namespace palpate::device
