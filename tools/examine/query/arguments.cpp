// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/arguments.h"

#include <charconv>

#include "tools/program/numbers.h"

namespace palpate::query {

NodeAndVector parseNodeAndVector(const std::string& option, const std::string& text) {
  NodeAndVector parsed;
  const char* const end = text.data() + text.size();
  const auto [colon, failure] = std::from_chars(text.data(), end, parsed.node);
  const bool node = failure == std::errc() && colon != end && *colon == ':';
  const auto vector = node ? program::readVector({colon + 1, end}) : std::nullopt;
  if (!vector)
    throw program::ValueError(option + " is '" + text +
                              "', expected a node's number and three finite numbers, NODE:x,y,z");
  parsed.vector = Vec3((*vector)[0], (*vector)[1], (*vector)[2]);
  return parsed;
}

}  // namespace palpate::query
