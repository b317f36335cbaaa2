// SPDX-License-Identifier: Apache-2.0
#include "core/tick/stepper.h"

#include <algorithm>
#include <cmath>

#include "core/contact/tool_group.h"

namespace palpate {

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

/// Longest that the arrivals of a good pose and the last one may lie apart, s, with a margin, because poses arrive unevenly.
double Stepper::between(const ToolInput& tool, const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING {
  constexpr double kUneven = 2e-3;  // s
  return std::max(0.0, memory.age + dt_ - 1e-9 * double(tool.age_ns)) + kUneven;
}

/// Whether a good pose is farther from the last one than a tool may move in the time between.
bool Stepper::leapt(const ToolInput& tool, const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING {
  if (!memory.known) return false;
  const Vec3 here(tool.position[0], tool.position[1], tool.position[2]);
  return (here - memory.position).norm() > work_.config_.speed_limit * between(tool, memory);
}

/// Whether so long no pose came, in a loop that would have taken one in every period, that the way from the last one
/// is not known.
bool Stepper::interrupted(const ToolInput& tool,
                          const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING {
  constexpr double kUneven = 2e-3;  // s, again: a period late is not lost
  return memory.known && between(tool, memory) - period_ > work_.config_.stale_timeout + 2.0 * kUneven;
}

ContactLaw Stepper::law(const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING {
  const LiveParameters& live = work_.live(numberOf(memory));
  return {live.friction, 1.0 / live.coupling_stiffness, live.youngs_modulus / model_.attributes().E, period_};
}

/// Advances the tools' live parameters, one that changes at once disturbs the contact; and exchanges tips that touch nothing.
void Stepper::changeLive() noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < kMaxTools; ++i) {
    ToolMemory& memory = work_.tools_[i];
    LiveBlend& live = work_.live_[i];
    const bool changes = input_.has_settings != 0;
    if (changes) work_.tip_radius_[i] = input_.settings[i].tip_radius;
    live.advance(changes ? input_.settings[i].live : live.target(), ramp_dt_,
                 memory.rendering.rendered.norm());
    const bool is_free = memory.contact.state == ContactState::kFree;
    if (is_free && work_.solver_[i].tipRadius() != work_.tip_radius_[i]) {
      work_.solver_[i] = ContactSolver(work_.tip_radius_[i]);
      ContactSolver::forget(memory.contact);  // its clearance is the old tip's
    }
    if (live.jumped() && !is_free) memory.leapt = true;
  }
}

/// Moves the contact to a pose. @return false when the model's answer is not finite; then nothing has moved
bool Stepper::follow(const ToolInput& tool, ToolMemory& memory,
                     ToolResult& out) noexcept PALPATE_NONBLOCKING {
  const Contact before = memory.contact;
  const Vec3 c(tool.position[0], tool.position[1], tool.position[2]);
  if (leapt(tool, memory)) {
    out.flags |= kPoseJump;
    ContactSolver::forget(memory.contact);
    memory.leapt = true;
  }
  const ContactSolver& solver = work_.solver_[numberOf(memory)];
  if (interrupted(tool, memory)) {
    solver.loseWay(model_, c, memory.contact);
    memory.leapt = memory.leapt || memory.contact.jumped;
  }
  Budget budget;
  solver.update(model_, law(memory), c, budget, memory.contact);
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
  const LiveParameters& live = work_.live(numberOf(memory));
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
  ToolGroup::Contacts contacts{};
  for (std::size_t i = 0; i < kMaxTools; ++i)
    if (work_.tools_[i].known) contacts[i] = &work_.tools_[i].contact;
  ToolGroup group(model_, contacts, work_.scratch_);
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

}  // namespace palpate
