// SPDX-License-Identifier: Apache-2.0
#include "core/devices/sim/held_device.h"

#include <algorithm>
#include <cmath>

namespace palpate::device {
namespace {

constexpr double kLongestSubstep = 50e-6;  // s; the rule is stable for any step, this one is for accuracy
constexpr int kFewestSubsteps = 10;

}  // namespace

HeldDevice::HeldDevice(const Mechanics& device, const Hand& hand, Path path)
    : device_(device), hand_(hand), path_(std::move(path)), x_(path_.at(0.0)) {
  check(device);
  check(hand);
}

void HeldDevice::place(const Point& position, const Point& velocity) noexcept {
  x_ = position;
  v_ = velocity;
}

double HeldDevice::energy() const noexcept {
  const Point stretch = path_.at(time_) - x_;
  return 0.5 * (device_.mass + hand_.mass) * dot(v_, v_) + 0.5 * hand_.stiffness * dot(stretch, stretch);
}

void HeldDevice::step(const Point& force_on_tool, double dt) noexcept PALPATE_NONBLOCKING {
  const int count = std::max(kFewestSubsteps, static_cast<int>(std::ceil(dt / kLongestSubstep)));
  for (int i = 0; i < count; ++i) substep(force_on_tool, dt / count);
}

// With w the mean velocity of the substep, x1 = x0 + h w and v1 = 2 w - v0, the midpoint rule is
//   A w + c w/|w| = r,   A = 2 (m + M)/h + b + B + h K/2,   r = 2 (m + M) v0/h + F + B y' + K (y_mid - x0),
// solved by w = r/A max(0, 1 - c/|r|).
void HeldDevice::substep(const Point& force_on_tool, double h) noexcept PALPATE_NONBLOCKING {
  const double inertia = 2.0 * (device_.mass + hand_.mass) / h;
  const Point from = path_.at(time_);
  const Point to = path_.at(time_ + h);
  const double A = inertia + device_.damping + hand_.damping + 0.5 * h * hand_.stiffness;
  const Point r = inertia * v_ + force_on_tool + (hand_.damping / h) * (to - from) +
                  hand_.stiffness * (0.5 * (from + to) - x_);
  const double size = length(r);
  const bool held = size <= device_.friction;
  const Point w = held ? Point{} : ((1.0 - device_.friction / size) / A) * r;
  v_ = held ? Point{} : 2.0 * w - v_;
  x_ = x_ + h * w;
  book(force_on_tool, w, h);
  time_ += h;
}

void HeldDevice::book(const Point& force_on_tool, const Point& w, double h) noexcept PALPATE_NONBLOCKING {
  const double force = length(force_on_tool), speed = length(w);
  if (!(force > 0.0) || !(speed > 0.0)) return;
  const double along = dot(force_on_tool, w) / force;
  along_force_.work += h * force * along;
  along_force_.damped += h * (device_.damping + hand_.damping + device_.friction / speed) * along * along;
  along_force_.speed_squared += h * along * along;
}

}  // namespace palpate::device
