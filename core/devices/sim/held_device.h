// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/devices/path/path.h"
#include "core/devices/sim/mechanics.h"

namespace palpate::device {

/// What happened along a force so far, v_F being the tip's velocity in its direction.
struct AlongForce {
  double work{0.0};  ///< of the force on the tool: the integral of F . dx, J. Below 0: the organ took energy
  double damped{0.0};         ///< what device and hand damp: that of (b + B) v_F^2 + c v_F^2/|v| dt, J
  double speed_squared{0.0};  ///< that of v_F^2 dt, m^2/s
};

/// A haptic device in a hand that follows a path, pushed by the organ:
///   (m + M) x'' = F - b x' - c x'/|x'| + B (y' - x') + K (y - x)
/// x is the tip, y the path, F the organ's force on the tool, c the Coulomb friction. The integrator is the implicit
/// midpoint rule in substeps of at most 50 us. In each substep the energy gains exactly what F and the hand's path put
/// in, less what is dissipated. So an instability belongs to the loop, not to the integrator. The friction inclusion is
/// solved exactly: where friction can hold the tip, the tip stands still.
class HeldDevice {
 public:
  /// Starts at rest where the path starts.
  /// @throw std::invalid_argument  a field of device or hand is out of range; it names the field
  HeldDevice(const Mechanics& device, const Hand& hand, Path path);

  /// Advances by dt. @param[in] force_on_tool  F, W, N, finite; held during dt. @param[in] dt  s, above 0
  /// Cost: one evaluation of the path per 50 us, at least 10. Real-time: yes. Threads: one.
  void step(const Point& force_on_tool, double dt) noexcept PALPATE_NONBLOCKING;

  /// Moves the tip there. The path is unchanged.
  void place(const Point& position, const Point& velocity) noexcept;

  [[nodiscard]] double time() const noexcept { return time_; }         ///< s since the start
  [[nodiscard]] const Point& position() const noexcept { return x_; }  ///< p_WT, m
  [[nodiscard]] const Point& velocity() const noexcept { return v_; }  ///< m/s
  [[nodiscard]] const Path& path() const noexcept { return path_; }
  /// Sums since the start. B counts with the tip's own velocity: it damps what a force adds to the motion that the hand wants.
  [[nodiscard]] const AlongForce& alongForce() const noexcept { return along_force_; }
  /// Kinetic energy plus the energy of the hand's spring, J.
  [[nodiscard]] double energy() const noexcept;

 private:
  void substep(const Point& force_on_tool, double h) noexcept PALPATE_NONBLOCKING;
  void book(const Point& force_on_tool, const Point& w, double h) noexcept PALPATE_NONBLOCKING;

  Mechanics device_;
  Hand hand_;
  Path path_;
  Point x_;
  Point v_{};
  double time_{0.0};
  AlongForce along_force_;
};

}  // namespace palpate::device
