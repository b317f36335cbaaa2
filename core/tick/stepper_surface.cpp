// SPDX-License-Identifier: Apache-2.0
// The surface of a step: what is shown of the field, and blended over where a contact jumps.
#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/kernels.h"
#include "core/tick/stepper.h"

namespace palpate {

/// The surface as shown. Where a contact jumps, the field blends over like the force: the weight of the
/// old field falls from 1 to 0 within ramp_time. One weight for the whole field, so that a second jump
/// starts from what is shown. A surface that nobody was shown for ramp_time has nothing to blend from.
void Stepper::deform(StepResult& result) noexcept PALPATE_NONBLOCKING {
  double& blend = work_.displacement_blend_;
  const double ramp_time = work_.config_.ramp_time;
  if (jumped_) {
    blend = work_.shown_age_ <= ramp_time ? 1.0 : 0.0;
    work_.blends_from_shown_ = true;
  }
  work_.shown_age_ += time_.ramp;
  blend = ramp_time > 0.0 ? std::max(0.0, blend - time_.ramp / ramp_time) : 0.0;
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
  const std::vector<float>& old = work_.blends_from_shown_ ? work_.displacement_ : work_.displacement_from_;
  for (std::size_t i = 0; weight > 0.0 && i < kMaxTools; ++i) {
    const ContactPoint& s = work_.tools_[i].contact.s;
    if (s.triangle < 0) continue;
    const Vec3 from = model_.surface().interpolate(old, s);
    shown_[i] = (1.0 - weight) * shown_[i] + weight * from;
  }
  return finite;
}

bool Stepper::showSurface(const MetaModel& model, Workspace& work) noexcept PALPATE_NONBLOCKING {
  std::vector<float>& u = work.displacement_;
  const auto weight = static_cast<float>(work.displacement_blend_);
  const bool begins = std::exchange(work.blends_from_shown_, false);
  work.shown_age_ = 0.0;
  if (weight == 0.0F && work.shown_known_ && work.shown_ == work.sources_) return false;
  if (begins && weight > 0.0F) std::copy(u.begin(), u.end(), work.displacement_from_.begin());
  work.overflowed_ = !evaluateSurface(model, work.sources_.all(), work.scratch_, u);
  work.shown_ = work.sources_;
  work.shown_known_ = weight == 0.0F && !work.overflowed_;
  if (weight > 0.0F) mixInto(work.displacement_from_, weight, u);  // no difference, which may overflow
  return true;
}

}  // namespace palpate
