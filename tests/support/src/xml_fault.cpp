// SPDX-License-Identifier: Apache-2.0
#include "palpate/testing/xml_fault.h"

#include <vector>

namespace palpate::testing {

std::string xmlFault(const std::string& text) {
  std::vector<std::string> open;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '&') {
      const std::string entity = text.substr(at, text.find(';', at) - at + 1);
      if (entity != "&amp;" && entity != "&lt;" && entity != "&gt;" && entity != "&quot;")
        return "entity " + entity;
    }
    if (text[at] != '<') {
      ++at;
      continue;
    }
    const std::size_t end = text.find('>', at);
    if (end == std::string::npos) return "a tag without end";
    std::string tag = text.substr(at + 1, end - at - 1);
    at = end + 1;
    if (tag.empty() || tag.find('<') != std::string::npos) return "tag '" + tag + "'";
    if (tag[0] == '?') continue;
    std::size_t quotes = 0;
    for (const char c : tag) quotes += c == '"' ? 1 : 0;
    if (quotes % 2 != 0) return "quotes of '" + tag + "'";
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return "closing '" + tag + "'";
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(tag.substr(0, tag.find_first_of(" \n")));
    }
  }
  return open.empty() ? "" : "'" + open.back() + "' stays open";
}

}  // namespace palpate::testing
