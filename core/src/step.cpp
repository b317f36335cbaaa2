// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels.h"
#include "tool_group.h"
#include "tool_surface.h"

namespace palpate {

/// One step() over one workspace.
class Stepper {
 public:
  Stepper(const MetaModel& model, Workspace& work, const StepInput& input) noexcept PALPATE_NONBLOCKING
      : model_(model),
        work_(work),
        input_(input),
        dt_(std::clamp(1e-9 * double(input.dt_ns), 0.0, 0.1)),
        period_(input.period_ns > 0 ? std::min(1e-9 * double(input.period_ns), 0.1) : 1e-3),
        ramp_dt_(std::min(dt_, 2.0 * period_)),
        disturbed_(1e-9 * double(input.dt_ns) > std::max(10.0 * period_, kStall)),
        shaken_(std::exchange(work.shaken_, false)) {}

  [[nodiscard]] StepStatus run(StepResult& result) noexcept PALPATE_NONBLOCKING;
  static void showSurface(const MetaModel& model, Workspace& work) noexcept PALPATE_NONBLOCKING;

 private:
  [[nodiscard]] std::uint32_t judge(const ToolInput& tool) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool leapt(const ToolInput& tool,
                           const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] ContactLaw law() const noexcept PALPATE_NONBLOCKING;
  void changeLive() noexcept PALPATE_NONBLOCKING;
  void advance(const ToolInput& tool, ToolMemory& memory, ToolResult& out) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool follow(const ToolInput& tool, ToolMemory& memory,
                            ToolResult& out) noexcept PALPATE_NONBLOCKING;
  void grow(const ToolInput& tool, ToolMemory& memory) const noexcept PALPATE_NONBLOCKING;
  void render(ToolMemory& memory, bool held, bool jumped, ToolResult& out) noexcept PALPATE_NONBLOCKING;
  void deform(StepResult& result) noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool showAnchors(const ToolSurface& surface) noexcept PALPATE_NONBLOCKING;
  void report(std::size_t tool, ToolResult& out) const noexcept PALPATE_NONBLOCKING;

  static constexpr double kStall = 0.01;  // s; in a faster loop, a hand does not notice ten periods

  const MetaModel& model_;
  Workspace& work_;
  const StepInput& input_;
  double dt_;
  double period_;   // s; the caller's, or 1 ms
  double ramp_dt_;  // s that ramps advance: without the time that the loop stood still
  bool disturbed_;  // the loop stood still, or a parameter changed at once: no force follows from the last
  bool jumped_{false};  // a contact jumped in this tick
  bool shaken_;         // a contact jumped in the last tick: what other tools feel of it jumps now
  std::array<Vec3, kMaxTools> shown_;  // u at each tool's anchor, m
};

namespace {

template <std::size_t N, typename Vector>
void store(const Vector& from, std::array<double, N>& to) noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < N; ++i) to[i] = from(static_cast<Eigen::Index>(i));
}

}  // namespace

/// Flags of the pose itself; 0 when it is usable.
std::uint32_t Stepper::judge(const ToolInput& tool) const noexcept PALPATE_NONBLOCKING {
  constexpr double kFarthest = 1000.0;  // m; larger than any scene, and squares stay finite
  for (const double x : tool.position)
    if (!(std::abs(x) <= kFarthest)) return kNonFinitePose;
  double square = 0.0;
  for (const double q : tool.orientation) {
    if (!std::isfinite(q)) return kNonFinitePose;
    square += q * q;
  }
  return std::abs(std::sqrt(square) - 1.0) <= work_.config_.quaternion_tolerance ? 0 : kNonUnitQuaternion;
}

/// Whether a good pose is farther from the last one than a tool may move in the time between their arrivals,
/// and a margin, because poses arrive unevenly.
bool Stepper::leapt(const ToolInput& tool, const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING {
  constexpr double kUneven = 2e-3;  // s
  if (!memory.known) return false;
  const double between = std::max(0.0, memory.age + dt_ - 1e-9 * double(tool.age_ns));
  const Vec3 here(tool.position[0], tool.position[1], tool.position[2]);
  return (here - memory.position).norm() > work_.config_.speed_limit * (between + kUneven);
}

ContactLaw Stepper::law() const noexcept PALPATE_NONBLOCKING {
  const LiveParameters& live = work_.live_.now();
  return {live.friction, 1.0 / live.coupling_stiffness, live.youngs_modulus / model_.attributes().E};
}

/// Advances the live parameters; one that changes at once disturbs the contacts.
void Stepper::changeLive() noexcept PALPATE_NONBLOCKING {
  double largest = 0.0;
  for (const ToolMemory& memory : work_.tools_) largest = std::max(largest, memory.rendering.rendered.norm());
  LiveBlend& live = work_.live_;
  live.advance(input_.has_live != 0 ? input_.live : live.target(), ramp_dt_, largest);
  disturbed_ = disturbed_ || live.jumped();
}

/// Moves the contact to a pose. @return false when the model's answer is not finite; then nothing has moved
bool Stepper::follow(const ToolInput& tool, ToolMemory& memory,
                     ToolResult& out) noexcept PALPATE_NONBLOCKING {
  const Contact before = memory.contact;
  const Vec3 c(tool.position[0], tool.position[1], tool.position[2]);
  if (leapt(tool, memory)) {
    out.flags |= kPoseJump;
    ContactSolver::release(memory.contact);
    memory.contact.overlapping = true;  // so a capture counts as a jump
    memory.leapt = true;
  }
  work_.solver_.update(model_, law(), c, memory.contact);
  memory.position = c;
  if (memory.contact.coupled.response.force.allFinite() && memory.contact.stiffness.allFinite()) return true;
  memory.contact = before;
  out.flags |= kNonFiniteForce;
  return false;
}

/// Age of a tool's last good pose in a tick without one.
void Stepper::grow(const ToolInput& tool, ToolMemory& memory) const noexcept PALPATE_NONBLOCKING {
  memory.age += dt_;
  if (tool.present != 0) memory.age = std::max(memory.age, 1e-9 * double(tool.age_ns));
  if (!memory.known) memory.age = std::max(memory.age, work_.config_.zero_after);
}

void Stepper::advance(const ToolInput& tool, ToolMemory& memory,
                      ToolResult& out) noexcept PALPATE_NONBLOCKING {
  if (tool.present == 0 && !memory.known) return;
  if (disturbed_ && memory.contact.state != ContactState::kFree) memory.leapt = true;
  if (tool.present != 0) out.flags |= judge(tool);
  const bool fresh = tool.present != 0 && 1e-9 * double(tool.age_ns) <= work_.config_.stale_timeout;
  const bool usable = fresh && out.flags == 0;
  const bool good = usable && input_.shutting_down == 0 && follow(tool, memory, out);
  const bool itself = good && (memory.contact.jumped || memory.was_stale || memory.leapt || !memory.known);
  const bool jumped = itself || (good && shaken_ && memory.contact.state != ContactState::kFree);
  work_.shaken_ = work_.shaken_ || itself;
  if (good) memory.leapt = false;
  if (usable && (out.flags & ~kPoseJump) == 0) {
    memory.age = std::max(0.0, 1e-9 * double(tool.age_ns));
    memory.known = true;
  } else {
    grow(tool, memory);
  }
  memory.was_stale = memory.age > work_.config_.stale_timeout;
  jumped_ = jumped_ || jumped;
  render(memory, !good, jumped, out);
}

/// Limits and fades the force. Releases a contact whose force has faded to zero.
void Stepper::render(ToolMemory& memory, bool held, bool jumped,
                     ToolResult& out) noexcept PALPATE_NONBLOCKING {
  LimiterInput in;
  const LiveParameters& live = work_.live_.now();
  if (held)
    memory.damper.wait(dt_);
  else
    in.force = -memory.damper.force(memory.contact, live.coupling_damping / live.coupling_stiffness, dt_);
  in.stiffness = -memory.contact.stiffness;
  in.force_limit = live.force_limit;
  in.force_rate_limit = live.force_rate_limit;
  in.age = memory.age;
  in.dt = ramp_dt_;
  in.period = period_;
  in.held = held;
  in.jumped = jumped;
  in.shutting_down = input_.shutting_down != 0;
  const LimitedForce limited = work_.limiter_.limit(in, memory.rendering);
  if (memory.rendering.gain <= 0.0) {
    work_.shaken_ = work_.shaken_ || memory.contact.state != ContactState::kFree;
    ContactSolver::release(memory.contact);
    memory.damper = {};
  }
  out.flags |= limited.flags | memory.contact.flags;
  store(limited.force, out.force);
  for (std::size_t i = 0; i < 9; ++i)
    out.stiffness[i] = limited.stiffness(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3));
}

/// The surface as shown. Where a contact jumps, the field blends over like the force: the weight of the
/// old field falls from 1 to 0 within ramp_time. One weight for the whole field, so that a second jump
/// starts from what is shown.
void Stepper::deform(StepResult& result) noexcept PALPATE_NONBLOCKING {
  double& blend = work_.displacement_blend_;
  if (jumped_) {
    std::copy(work_.displacement_.begin(), work_.displacement_.end(), work_.displacement_from_.begin());
    blend = 1.0;
  }
  const double ramp_time = work_.config_.ramp_time;
  blend = ramp_time > 0.0 ? std::max(0.0, blend - ramp_dt_ / ramp_time) : 0.0;
  const ToolSurface surface(model_, work_.tools_, work_.scratch_);
  work_.sources_.keep(surface.sources());
  const bool overflowed = std::exchange(work_.overflowed_, false);  // found again while it lasts
  const bool finite = showAnchors(surface) && !overflowed;
  if (finite) return;
  for (ToolResult& out : result.tools)
    if ((out.flags & kInContact) != 0) out.flags |= kNonFiniteForce;
}

/// The surface where it is reported.
bool Stepper::showAnchors(const ToolSurface& surface) noexcept PALPATE_NONBLOCKING {
  const bool finite = surface.atAnchors(shown_);
  const double weight = work_.displacement_blend_;
  for (std::size_t i = 0; weight > 0.0 && i < kMaxTools; ++i) {
    const ContactPoint& s = work_.tools_[i].contact.s;
    if (s.triangle < 0) continue;
    const Vec3 from = model_.surface().interpolate(work_.displacement_from_, s);
    shown_[i] = (1.0 - weight) * shown_[i] + weight * from;
  }
  return finite;
}

void Stepper::showSurface(const MetaModel& model, Workspace& work) noexcept PALPATE_NONBLOCKING {
  std::vector<float>& u = work.displacement_;
  const auto weight = static_cast<float>(work.displacement_blend_);
  if (weight == 0.0F && work.shown_known_ && work.shown_ == work.sources_) return;
  work.overflowed_ = !evaluateSurface(model, work.sources_.all(), work.scratch_, u);
  work.shown_ = work.sources_;
  work.shown_known_ = weight == 0.0F && !work.overflowed_;
  if (weight > 0.0F) mixInto(work.displacement_from_, weight, u);  // no difference, which may overflow
}

void Stepper::report(std::size_t tool, ToolResult& out) const noexcept PALPATE_NONBLOCKING {
  const Contact& contact = work_.tools_[tool].contact;
  if (contact.s.triangle < 0) return;
  out.state = static_cast<std::uint32_t>(contact.state);
  store(contact.anchor, out.anchor);
  store(Vec3(contact.anchor + shown_[tool]), out.proxy);
  store(contact.coupled.response.displacement, out.displacement);
  out.domain_radius = contact.coupled.response.domain_radius;
  out.penetration = std::max(0.0, -contact.imposed.dot(contact.normal));
}

StepStatus Stepper::run(StepResult& result) noexcept PALPATE_NONBLOCKING {
  result = StepResult{};
  changeLive();
  ToolGroup group(model_, work_.tools_, work_.scratch_);
  group.feelEachOther();
  for (std::size_t i = 0; i < kMaxTools; ++i) {
    advance(input_.tools[i], work_.tools_[i], result.tools[i]);
    group.hasMoved(i);
  }
  deform(result);
  std::uint32_t flags = 0;
  for (std::size_t i = 0; i < kMaxTools; ++i) {
    report(i, result.tools[i]);
    result.tools[i].flags |= input_.tools[i].flags;
    flags |= result.tools[i].flags;
    const bool gone = input_.tools[i].present == 0 && work_.tools_[i].rendering.gain <= 0.0;
    if (gone) work_.tools_[i] = ToolMemory{};
  }
  return (flags & ~kInContact) == 0 ? StepStatus::kOk : StepStatus::kFlagged;
}

StepStatus stepForces(const MetaModel& model, Workspace& work, const StepInput& input,
                      StepResult& result) noexcept PALPATE_NONBLOCKING {
  return Stepper(model, work, input).run(result);
}

void stepSurface(const MetaModel& model, Workspace& work) noexcept PALPATE_NONBLOCKING {
  Stepper::showSurface(model, work);
}

StepStatus step(const MetaModel& model, Workspace& work, const StepInput& input,
                StepResult& result) noexcept PALPATE_NONBLOCKING {
  const StepStatus status = stepForces(model, work, input, result);
  if (input.skip_surface == 0) stepSurface(model, work);
  return status;
}

}  // namespace palpate
