// SPDX-License-Identifier: Apache-2.0
#include "core/contact/tool_group.h"

#include <algorithm>

namespace palpate {

void ToolGroup::feelEachOther() noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (contacts_[i] == nullptr) continue;
    Contact& contact = *contacts_[i];
    contact.carried = {};
    if (contact.isFree()) continue;
    s_[count_] = contact.s;
    d_[count_] = contact.coupled.displacement;
    pressing_[count_++] = i;
  }
  if (count_ == 0) return;
  ownDisplacements(model_, std::span(s_).first(count_), std::span(d_).first(count_), scratch_, own_,
                   &influence_);
  for (std::size_t i = 0; i < count_; ++i) {
    const Mat3& slope = influence_[i][i];
    contacts_[pressing_[i]]->carried = {.constant = d_[i] - own_[i] - slope * d_[i], .slope = slope};
  }
  if (count_ > 1) feelSlopes();
  approach();
}

/// How what each feels of the others changes as it slides.
void ToolGroup::feelSlopes() noexcept PALPATE_NONBLOCKING {
  std::array<FieldSource, 2 * kMaxTools> sources;
  for (std::size_t i = 0; i < count_; ++i) {
    const auto parts = ownField(model_, s_[i], d_[i], own_[i]);
    std::copy(parts.begin(), parts.end(), sources.begin() + static_cast<std::ptrdiff_t>(2 * i));
  }
  for (std::size_t i = 0; i < count_; ++i) {
    std::array<FieldSource, 2 * kMaxTools> others = sources;
    for (std::size_t k = 2 * i; k < 2 * i + 2; ++k) others[k] = sources[2 * count_ - 2 + k % 2];
    Carried& carried = contacts_[pressing_[i]]->carried;
    carried.along = patchDisplacementSlope(model_, std::span(others).first(2 * count_ - 2), s_[i], scratch_);
    carried.origin = model_.surface().position(s_[i]);
  }
}

/// What tools in the air would find displaced.
void ToolGroup::approach() noexcept PALPATE_NONBLOCKING {
  for (Contact* const place : contacts_) {
    if (place == nullptr || !place->isFree() || place->s.triangle < 0) continue;
    Contact& contact = *place;
    for (std::size_t i = 0; i < count_; ++i)
      for (const FieldSource& source : ownField(model_, s_[i], d_[i], own_[i]))
        contact.carried.constant += patchDisplacement(model_, source, contact.s, scratch_);
    if (!contact.carried.constant.allFinite())
      contact.carried = {};  // otherwise no point would be searched again
  }
}

void ToolGroup::hasMoved(std::size_t tool) noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < count_; ++i) {
    if (pressing_[i] != tool) continue;
    const Contact& contact = *contacts_[tool];
    if (contact.isFree() || contact.jumped()) return;  // the others feel that in the next tick
    for (std::size_t later = i + 1; later < count_; ++later)
      contacts_[pressing_[later]]->carried.constant +=
          influence_[later][i] * (contact.coupled.displacement - d_[i]);
  }
}

}  // namespace palpate
