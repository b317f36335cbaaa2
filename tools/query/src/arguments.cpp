// SPDX-License-Identifier: Apache-2.0
#include "palpate/query/arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "palpate/query/query_error.h"

namespace palpate::query {

namespace {

/// Three finite numbers and nothing else. @return whether the text is that
bool readVector(const char* at, const char* end, Vec3& vector) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [next, failure] = std::from_chars(at, end, vector[axis]);
    const bool ends_well = axis < 2 ? next != end && *next == ',' : next == end;
    if (failure != std::errc() || !ends_well || !std::isfinite(vector[axis])) return false;
    at = axis < 2 ? next + 1 : next;
  }
  return true;
}

}  // namespace

Vec3 parseVector(const std::string& option, const std::string& text) {
  Vec3 vector = Vec3::Zero();
  if (!readVector(text.data(), text.data() + text.size(), vector))
    throw QueryError(option + " is '" + text + "', expected three finite numbers x,y,z");
  return vector;
}

NodeAndVector parseNodeAndVector(const std::string& option, const std::string& text) {
  NodeAndVector parsed;
  const char* const end = text.data() + text.size();
  const auto [colon, failure] = std::from_chars(text.data(), end, parsed.node);
  if (failure != std::errc() || colon == end || *colon != ':' || !readVector(colon + 1, end, parsed.vector))
    throw QueryError(option + " is '" + text +
                     "', expected a node's number and three finite numbers, NODE:x,y,z");
  return parsed;
}

std::vector<std::string> joinVectors(std::span<const char* const> words,
                                     std::span<const char* const> options) {
  std::vector<std::string> joined;
  for (std::size_t i = 0; i < words.size(); ++i) {
    joined.emplace_back(words[i]);
    const bool takes_vector = std::find(options.begin(), options.end(), joined.back()) != options.end();
    // Another option in its place stays one, so that the parser can name what lacks a value.
    if (takes_vector && i + 1 < words.size() && std::string(words[i + 1]).rfind("--", 0) != 0)
      joined.back() += std::string("=") + words[++i];
  }
  return joined;
}

}  // namespace palpate::query
