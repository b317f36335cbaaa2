// SPDX-License-Identifier: Apache-2.0
// The surface of a step: what it is made of, and where it is at the anchors.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/length.h"
#include "core/tick/stepper.h"
#include "core/tick/tool_surface.h"

namespace palpate {

/// What the surface is made of. Where a contact jumps, surface and proxies blend over like the force: the weight of the
/// old ones falls from 1 to 0 within ramp_time.
void Stepper::deform(StepResult& result) noexcept PALPATE_NONBLOCKING {
  SurfaceState& surface = work_.surface_;
  const double ramp_time = work_.config_.ramp_time;
  if (jumped_) {
    ++surface.jumps;
    surface.blend = 1.0;
  }
  surface.blend = ramp_time > 0.0 ? std::max(0.0, surface.blend - time_.ramp / ramp_time) : 0.0;
  findSources(model_, work_.tools_, surface.sources);
  std::array<Vec3, kMaxTools> u;
  const bool finite =
      fieldAtAnchors(model_, work_.tools_, surface.sources.all(), work_.scratch_, work_.touches_, u);
  for (std::size_t i = 0; i < kMaxTools; ++i) showAnchor(u[i], work_.tools_[i]);
  if (finite && input_.field_overflowed == 0) return;
  for (ToolResult& out : result.tools)
    if ((out.flags & kInContact) != 0) out.flags |= kNonFiniteForce;
}

/// The displacement that a tool's proxy is reported with. After a jump it comes from the one reported before; of an
/// anchor that leapt elsewhere from as much of that as a dimple of the patch's width has there.
void Stepper::showAnchor(const Vec3& u, ToolMemory& memory) const noexcept PALPATE_NONBLOCKING {
  if (memory.contact.s.triangle < 0) return;
  ShownAnchor& shown = memory.shown;
  if (jumped_) {
    const double leap = lengthOf(memory.contact.anchor - shown.anchor) / model_.attributes().patch_radius;
    shown.from = std::exp(-0.5 * leap * leap) * shown.u;
  }
  const double weight = work_.surface_.blend;
  shown.anchor = memory.contact.anchor;
  shown.u = weight > 0.0 ? Vec3((1.0 - weight) * u + weight * shown.from) : u;
}

}  // namespace palpate
