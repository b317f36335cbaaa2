// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/role.h"

#include <algorithm>

#include "palpate/idl/topics.h"

namespace palpate::dds {
namespace {

template <class... T>
std::vector<std::string_view> namesOf() {
  return {TopicTraits<T>::kName...};
}

}  // namespace

std::string_view wordOf(Role role) noexcept {
  switch (role) {
    case Role::kServer:
      return "server";
    case Role::kDriver:
      return "driver";
    case Role::kViewer:
      return "viewer";
    case Role::kOperator:
      break;
  }
  return "operator";
}

std::optional<Role> roleOf(std::string_view word) noexcept {
  const auto* const role =
      std::find_if(kRoles.begin(), kRoles.end(), [word](Role one) { return wordOf(one) == word; });
  return role == kRoles.end() ? std::nullopt : std::optional(*role);
}

std::vector<std::string_view> topicsWrittenBy(Role role) {
  switch (role) {
    case Role::kServer:
      return namesOf<ToolForce, SurfaceDisplacement, SurfaceMesh, ServerStatus, ServerParameters>();
    case Role::kDriver:
      return namesOf<ToolPose, ToolAnnouncement>();
    case Role::kViewer:
      return {};
    case Role::kOperator:
      break;
  }
  return namesOf<ParameterRequest, ToolPose>();  // its page moves a tool with the mouse
}

bool mayWrite(Role role, std::string_view topic) {
  const std::vector<std::string_view> written = topicsWrittenBy(role);
  return std::find(written.begin(), written.end(), topic) != written.end();
}

std::string wordsOf(std::initializer_list<Role> roles) {
  std::string words;
  for (const Role role : roles) words.append(words.empty() ? "" : " or ").append(wordOf(role));
  return words;
}

}  // namespace palpate::dds
