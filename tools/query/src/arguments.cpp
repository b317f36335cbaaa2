// SPDX-License-Identifier: Apache-2.0
#include "palpate/query/arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "palpate/query/query_error.h"

namespace palpate::query {

Vec3 parseVector(const std::string& option, const std::string& text) {
  Vec3 vector = Vec3::Zero();
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int axis = 0; axis < 3; ++axis) {
    const auto [next, failure] = std::from_chars(at, end, vector[axis]);
    const bool ends_well = axis < 2 ? next != end && *next == ',' : next == end;
    if (failure != std::errc() || !ends_well || !std::isfinite(vector[axis]))
      throw QueryError(option + " is '" + text + "', expected three finite numbers x,y,z");
    at = axis < 2 ? next + 1 : next;
  }
  return vector;
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
