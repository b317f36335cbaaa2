// SPDX-License-Identifier: Apache-2.0
#include "core/tick/tool_surface.h"

#include <algorithm>
#include <array>

#include "core/response/tool_coupling.h"

namespace palpate {

void findSources(const MetaModel& model, std::span<const ToolMemory, kMaxTools> tools,
                 FieldSources& sources) noexcept PALPATE_NONBLOCKING {
  sources.clear();
  for (const ToolMemory& tool : tools) {
    const Contact& contact = tool.contact;
    const double gain = tool.rendering.gain;
    if (contact.isFree()) continue;
    const Vec3& d = contact.coupled.displacement;
    const Vec3 carried = contact.carried.at(d);
    if (carried == Vec3::Zero()) {
      sources.add({contact.s, contact.coupled.response.parameter, gain});
      continue;
    }
    for (FieldSource source : ownField(model, contact.s, d, d - carried)) {
      source.gain *= gain;
      sources.add(source);
    }
  }
}

namespace {

/// What each tool in contact does elsewhere, as findSources() has it.
std::span<const ToolPart> findParts(std::span<const ToolMemory, kMaxTools> tools,
                                    std::span<ToolPart, kMaxTools> parts) noexcept PALPATE_NONBLOCKING {
  std::size_t count = 0;
  for (const ToolMemory& tool : tools) {
    const Contact& contact = tool.contact;
    if (contact.isFree()) continue;
    const Vec3& d = contact.coupled.displacement;
    const Vec3 carried = contact.carried.at(d);
    const bool alone = carried == Vec3::Zero();
    const Vec3& moved = alone ? contact.coupled.response.parameter : d;
    parts[count++] = {contact.s, moved, moved - carried, tool.rendering.gain};
  }
  return parts.first(count);
}

}  // namespace

bool fieldAtAnchors(const MetaModel& model, std::span<const ToolMemory, kMaxTools> tools,
                    std::span<const FieldSource> sources, FieldScratch& scratch, Touches& touches,
                    std::span<Vec3, kMaxTools> u) noexcept PALPATE_NONBLOCKING {
  std::fill(u.begin(), u.end(), Vec3::Zero());
  if (sources.empty()) return true;
  std::array<ContactPoint, kMaxTools> anchors;
  for (std::size_t i = 0; i < tools.size(); ++i) anchors[i] = tools[i].contact.s;
  fieldAt(model, sources, scratch, anchors, u);
  std::array<ToolPart, kMaxTools> parts;
  if (model.isDisplacementDriven()) addOthersAt(model, findParts(tools, parts), touches, anchors, u);
  bool finite = true;
  for (Vec3& shown : u) {
    if (shown.allFinite()) continue;
    shown.setZero();
    finite = false;
  }
  return finite;
}

}  // namespace palpate
