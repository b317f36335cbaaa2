// SPDX-License-Identifier: Apache-2.0
#include "core/tick/tool_surface.h"

#include <algorithm>

#include "core/base/kernels.h"
#include "core/model/field_evaluation.h"
#include "core/response/tool_coupling.h"

namespace palpate {

ToolSurface::ToolSurface(const MetaModel& model, std::span<const ToolMemory, kMaxTools> tools,
                         FieldScratch& scratch) noexcept PALPATE_NONBLOCKING : model_(model),
                                                                               scratch_(scratch) {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    const Contact& contact = tools[i].contact;
    const double gain = tools[i].rendering.gain;
    anchors_[i] = contact.s;
    if (contact.isFree()) continue;
    const Vec3& d = contact.coupled.displacement;
    const Vec3 carried = contact.carried.at(d);
    if (carried == Vec3::Zero()) {
      sources_[count_++] = {contact.s, contact.coupled.response.parameter, gain};
      continue;
    }
    for (FieldSource source : ownField(model_, contact.s, d, d - carried)) {
      source.gain *= gain;
      sources_[count_++] = source;
    }
  }
  findAmplitudes(model_, sources(), scratch.amplitudes);
}

std::span<const FieldSource> ToolSurface::sources() const noexcept PALPATE_NONBLOCKING {
  return std::span(sources_).first(count_);
}

bool ToolSurface::atAnchors(std::span<Vec3, kMaxTools> u) const noexcept PALPATE_NONBLOCKING {
  std::fill(u.begin(), u.end(), Vec3::Zero());
  if (count_ == 0) return true;
  fieldAt(model_, sources(), scratch_, anchors_, u);
  bool finite = true;
  for (Vec3& shown : u) {
    if (shown.allFinite()) continue;
    shown.setZero();
    finite = false;
  }
  return finite;
}

bool evaluateSurface(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
                     std::span<float> u) noexcept PALPATE_NONBLOCKING {
  if (!sources.empty()) {
    fieldOf(model, sources, scratch, u);
    if (allFinite(u)) return true;
  }
  std::fill(u.begin(), u.end(), 0.0F);
  return sources.empty();
}

}  // namespace palpate
