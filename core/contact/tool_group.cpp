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
  ownDisplacements(model_, std::span(s_).first(count_), std::span(d_).first(count_), touches_, own_,
                   &influence_);
  for (std::size_t i = 0; i < count_; ++i) {
    const Mat3& slope = influence_.by_d[i][i];
    contacts_[pressing_[i]]->carried = {.constant = d_[i] - own_[i] - slope * d_[i],
                                        .slope = slope,
                                        .along = influence_.along[i],
                                        .origin = model_.surface().position(s_[i])};
  }
  approach();
}

/// What tools in the air would find displaced.
void ToolGroup::approach() noexcept PALPATE_NONBLOCKING {
  const double step = tangentStep(std::span(d_).first(count_));
  std::size_t place = count_;  // of a touch that no pressing tool has
  for (Contact* const tool : contacts_) {
    if (tool == nullptr || !tool->isFree() || tool->s.triangle < 0) continue;
    Contact& contact = *tool;
    if (count_ > 0) touches_.all[place].patch.moveTo(model_, contact.s);
    for (std::size_t i = 0; i < count_; ++i) {
      touchWith(model_, s_[i], d_[i], step, touches_.all[i]);
      contact.carried.constant +=
          patchMotion(model_, touches_.all[i], touches_.all[place]).at(own_[i] - d_[i]);
    }
    ++place;
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
          influence_.by_d[later][i] * (contact.coupled.displacement - d_[i]);
  }
}

}  // namespace palpate
