// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/base/contact_point.h"
#include "core/base/max_tools.h"
#include "core/base/types.h"
#include "core/contact/contact.h"
#include "core/model/meta_model.h"
#include "core/model/touch_field.h"
#include "core/response/tool_coupling.h"

namespace palpate {

/// The tools of one tick, and what each feels of the others.                          docs/design.md, Contact
/// The organ between them is taken as its tangent at the contacts that the last tick left. Tools move one after the
/// other, each with what it feels of itself through the others (Contact::carried's slope) and the others as they are by
/// then: a descent in the energy of all, tool by tool (Gauss-Seidel), where the others as they were a tick ago would
/// make a loop that rings or grows.
class ToolGroup {
 public:
  /// By tool; none where no pose of the tool was seen.
  using Contacts = std::array<Contact*, kMaxTools>;

  ToolGroup(const MetaModel& model, const Contacts& contacts, Touches& touches) noexcept PALPATE_NONBLOCKING
      : model_(model),
        contacts_(contacts),
        touches_(touches) {}

  /// Sets each contact's `carried`. Real-time: yes.
  void feelEachOther() noexcept PALPATE_NONBLOCKING;
  /// A tool has moved in this tick: those that come after it feel it where it now is. Real-time: yes.
  void hasMoved(std::size_t tool) noexcept PALPATE_NONBLOCKING;

 private:
  void approach() noexcept PALPATE_NONBLOCKING;

  const MetaModel& model_;
  Contacts contacts_;
  Touches& touches_;
  std::size_t count_{0};                           // of tools in contact:
  std::array<std::size_t, kMaxTools> pressing_{};  // their numbers, rising,
  std::array<ContactPoint, kMaxTools> s_;          // where they are
  std::array<Vec3, kMaxTools> d_, own_;            // and what they prescribe, m
  Influence influence_;
};

}  // namespace palpate
