// SPDX-License-Identifier: Apache-2.0
#include "header_text.h"

#include <algorithm>

namespace palpate::viewer {
namespace {

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

// The part of a list before the next separator; the list loses both.
std::string_view takePart(std::string_view& list, char separator) {
  const std::size_t end = std::min(list.find(separator), list.size());
  const std::string_view part = trimmed(list.substr(0, end));
  list.remove_prefix(std::min(end + 1, list.size()));
  return part;
}

}  // namespace

std::string_view bearerIn(std::string_view header) {
  static constexpr std::string_view kScheme = "Bearer ";
  return header.starts_with(kScheme) ? trimmed(header.substr(kScheme.size())) : std::string_view();
}

std::string_view cookieIn(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::string_view cookie = takePart(header, ';');
    if (cookie.starts_with(name) && cookie.substr(name.size()).starts_with('='))
      return cookie.substr(name.size() + 1);
  }
  return {};
}

bool names(std::string_view list, std::string_view name) {
  while (!list.empty())
    if (takePart(list, ',') == name) return true;
  return false;
}

}  // namespace palpate::viewer
