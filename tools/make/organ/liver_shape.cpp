// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/liver_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace palpate::organ {
namespace {

// A control point in the middle of the right and of the left lobe, and how much of the notches it takes.
struct Control {
  double right_y, right_z, left_y, left_z;  // m
  double edge;                              // of a notch
  double groove;                            // of the falciform groove in front
};

constexpr std::array<Control, 14> kControls{{
    {0.058, 0.010, 0.036, 0.028, 0.0, 0.0},      // back
    {0.052, -0.016, 0.035, 0.020, 0.0, 0.0},     // under-side
    {0.034, -0.026, 0.022, 0.015, 0.0, 0.0},     //
    {0.008, -0.033, 0.006, 0.011, 0.2, 0.0},     //
    {-0.018, -0.043, -0.011, 0.006, 0.5, 0.0},   //
    {-0.040, -0.058, -0.027, 0.001, 0.8, 0.0},   //
    {-0.053, -0.065, -0.038, -0.003, 1.0, 0.0},  // inferior edge
    {-0.060, -0.055, -0.040, 0.003, 1.0, 0.3},   //
    {-0.064, -0.022, -0.034, 0.014, 0.45, 1.0},  // front
    {-0.063, 0.014, -0.025, 0.026, 0.1, 1.0},    //
    {-0.050, 0.048, -0.013, 0.036, 0.0, 0.8},    // dome
    {-0.018, 0.068, 0.001, 0.042, 0.0, 0.4},     //
    {0.020, 0.066, 0.017, 0.043, 0.0, 0.0},      //
    {0.047, 0.044, 0.031, 0.038, 0.0, 0.0},      //
}};

constexpr double kRightLobe = -0.045, kLeftLobe = 0.095;  // m, x where a lobe's section is its own alone

// The ends close like half an ellipse: full section at `from`, a small flat cap at `cap`.
struct End {
  double from, cap;
};
constexpr End kRightEnd{-0.045, -0.107}, kLeftEnd{0.062, 0.118};
constexpr double kPastCap = 0.0016;  // m; the ellipse would close so far beyond the cap

struct Notch {
  double x, width;            // m; exp(-((X - x) / width)^2)
  double up, back, in_front;  // m: of the edge, and of the front above it
};
constexpr Notch kGallBladder{0.001, 0.013, 0.025, 0.014, 0.0};
constexpr Notch kFalciform{0.043, 0.013, 0.010, 0.005, 0.003};

double smoothStep(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double closing(double x, const End& end) {
  const double way = (x - end.from) / (end.cap + std::copysign(kPastCap, end.cap) - end.from);
  return way > 0 ? std::sqrt(1 - way * way) : 1.0;
}

LiverSection sectionAt(double x) {
  const double left = smoothStep((x - kRightLobe) / (kLeftLobe - kRightLobe));
  const double size = closing(x, kRightEnd) * closing(x, kLeftEnd);
  LiverSection section{x, {}};
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const Control& c : kControls) {
    section.points.push_back((1 - left) * Eigen::Vector2d(c.right_y, c.right_z) +
                             left * Eigen::Vector2d(c.left_y, c.left_z));
    centre += section.points.back() / static_cast<double>(kControls.size());
  }
  for (std::size_t i = 0; i < kControls.size(); ++i) {
    Eigen::Vector2d& p = section.points[i];
    p = centre + size * (p - centre);
    for (const Notch& notch : {kGallBladder, kFalciform}) {
      const double t = (x - notch.x) / notch.width;
      const Eigen::Vector2d moved = kControls[i].edge * Eigen::Vector2d(notch.back, notch.up) +
                                    kControls[i].groove * Eigen::Vector2d(notch.in_front, 0);
      p += std::exp(-t * t) * moved;
    }
  }
  return section;
}

// Places that take the curve of an end in even steps of its angle, from the full section to the cap.
std::vector<double> placesTowards(const End& end) {
  constexpr int kSteps = 8;
  const double length = end.cap + std::copysign(kPastCap, end.cap) - end.from;
  const double last = std::asin((end.cap - end.from) / length);
  std::vector<double> places;
  for (int i = 1; i <= kSteps; ++i) places.push_back(end.from + length * std::sin(last * i / kSteps));
  return places;
}

}  // namespace

std::vector<LiverSection> liverSections() {
  std::vector<double> places = placesTowards(kRightEnd);
  std::reverse(places.begin(), places.end());
  constexpr int kBetween = 11;
  for (int i = 0; i <= kBetween; ++i)
    places.push_back(kRightEnd.from + (kLeftEnd.from - kRightEnd.from) * i / kBetween);
  for (const double x : placesTowards(kLeftEnd)) places.push_back(x);
  std::vector<LiverSection> sections;
  for (const double x : places) sections.push_back(sectionAt(x));
  return sections;
}

}  // namespace palpate::organ
