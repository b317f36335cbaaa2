// SPDX-License-Identifier: Apache-2.0
#include "core/tick/stepper.h"

#include <algorithm>
#include <array>

#include "core/base/prefetch.h"
#include "core/contact/tool_group.h"

namespace palpate {

namespace {

template <std::size_t N, typename Vector>
void store(const Vector& from, std::array<double, N>& to) noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < N; ++i) to[i] = from(static_cast<Eigen::Index>(i));
}

}  // namespace

ContactLaw Stepper::law(const ToolMemory& memory) const noexcept PALPATE_NONBLOCKING {
  const LiveParameters& live = work_.live(numberOf(memory));
  return {live.friction, 1.0 / live.coupling_stiffness, live.youngs_modulus / model_.attributes().E,
          time_.period};
}

/// Other threads have filled the cache since the last tick.
void Stepper::expect() const noexcept PALPATE_NONBLOCKING {
  for (const ToolMemory& memory : work_.tools_) {
    if (memory.contact.isFree() || memory.contact.s.triangle < 0) continue;
    model_.expect(memory.contact.s, memory.contact.fine);
    prefetch(memory);
  }
}

/// Advances the tools' live parameters, and exchanges tips that touch nothing.
void Stepper::changeLive() noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < kMaxTools; ++i) {
    ToolMemory& memory = work_.tools_[i];
    LiveBlend& live = work_.live_[i];
    const bool changes = input_.has_settings != 0;
    if (changes) work_.tip_radius_[i] = input_.settings[i].tip_radius;
    live.advance(changes ? input_.settings[i] : live.target(), time_.ramp, memory.rendering.rendered.norm());
    if (!memory.contact.isFree()) {
      if (live.jumped()) memory.continuity.disturb(kParameterSwitched);
    } else if (work_.solver_[i].tipRadius() != work_.tip_radius_[i]) {
      work_.solver_[i] = ContactSolver(work_.tip_radius_[i]);
      ContactSolver::forget(memory.contact);  // its clearance is the old tip's
    }
  }
}

/// Moves the contact to a pose. @return false when the model's answer is not finite; then nothing has moved
bool Stepper::follow(const ToolInput& tool, TipWay way, ToolMemory& memory,
                     ToolResult& out) noexcept PALPATE_NONBLOCKING {
  if (way == TipWay::kNone) {
    out.flags |= kPoseJump;
    memory.continuity.disturb(kPoseLeapt);
  }
  const Vec3 c(tool.position[0], tool.position[1], tool.position[2]);
  Budget budget;
  const ContactSolver& solver = work_.solver_[numberOf(memory)];
  if (solver.update(model_, law(memory), c, way, budget, memory.contact)) return true;
  out.flags |= kNonFiniteForce;
  return false;
}

/// One tool: its pose, its contact, whether its force goes on, its force.
void Stepper::advance(const ToolInput& tool, ToolMemory& memory,
                      ToolResult& out) noexcept PALPATE_NONBLOCKING {
  Continuity& continuity = memory.continuity;
  if (tool.present == 0 && !continuity.known()) return;
  if (time_.stood_still && !memory.contact.isFree()) continuity.disturb(kLoopStoodStill);
  const PoseJudgement pose = continuity.judge(tool, time_, work_.config_);
  out.flags |= pose.flags;
  const bool stops = input_.shutting_down != 0;
  const bool moved = pose.usable && !stops && follow(tool, pose.way, memory, out);
  const std::uint32_t causes = moved ? continuity.take(memory.contact, shaken_, work_.config_) : 0;
  work_.shaken_ = work_.shaken_ || (causes & ~kOthersJumped) != 0;
  jumped_ = jumped_ || causes != 0;
  continuity.end(tool, pose.usable && (moved || stops), time_, work_.config_);
  render(memory, !moved, causes != 0, out);
}

/// Limits and fades the force. Releases a contact whose force has faded to zero.
void Stepper::render(ToolMemory& memory, bool held, bool jumped,
                     ToolResult& out) noexcept PALPATE_NONBLOCKING {
  LimiterInput in;
  const LiveParameters& live = work_.live(numberOf(memory));
  if (held)
    memory.damper.wait(time_.since_last);
  else
    in.force =
        -memory.damper.force(memory.contact, work_.live_[numberOf(memory)].dampingTime(), time_.since_last);
  in.stiffness = -memory.contact.stiffness;
  in.force_limit = live.force_limit;
  in.force_rate_limit = live.force_rate_limit;
  in.age = memory.continuity.age();
  in.dt = time_.ramp;
  in.period = time_.period;
  in.held = held;
  in.jumped = jumped;
  in.hands_over = input_.shutting_down == kHandsOver;
  in.shutting_down = input_.shutting_down != 0 && !in.hands_over;
  const LimitedForce limited = work_.limiter_.limit(in, memory.rendering);
  if (memory.rendering.gain <= 0.0) {
    work_.shaken_ = work_.shaken_ || !memory.contact.isFree();
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
  store(Vec3(contact.anchor + work_.tools_[tool].shown.u), out.proxy);
  store(contact.coupled.response.displacement, out.displacement);
  out.domain_radius = contact.coupled.response.domain_radius;
  out.penetration = std::max(0.0, -contact.imposed.dot(contact.normal));
}

StepStatus Stepper::run(StepResult& result) noexcept PALPATE_NONBLOCKING {
  expect();
  result = StepResult{};
  changeLive();
  ToolGroup::Contacts contacts{};
  for (std::size_t i = 0; i < kMaxTools; ++i)
    if (work_.tools_[i].continuity.known()) contacts[i] = &work_.tools_[i].contact;
  ToolGroup group(model_, contacts, work_.touches_);
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
