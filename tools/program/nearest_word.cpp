// SPDX-License-Identifier: Apache-2.0
#include "tools/program/nearest_word.h"

#include <algorithm>
#include <cstddef>

namespace palpate::program {
namespace {

std::string_view withoutDashes(std::string_view word) {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

// Edits from a to b. Row i of the table holds those from the first i letters of a; three rows are enough.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t other = a[i - 1] == b[j - 1] ? 0 : 1;
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + other});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(now);
  }
  return last[b.size()];
}

}  // namespace

std::optional<std::string> nearestWord(std::string_view word, const std::vector<std::string>& known) {
  const std::string_view given = withoutDashes(word);
  if (given.size() < 2) return std::nullopt;
  std::size_t least = std::min<std::size_t>(2, (given.size() + 2) / 3) + 1;
  std::optional<std::string> nearest;
  for (const std::string& candidate : known) {
    const std::string_view other = withoutDashes(candidate);
    const std::size_t count = other.starts_with(given) ? 0 : edits(given, other);
    if (count >= least) continue;
    least = count;
    nearest = candidate;
  }
  return nearest;
}

}  // namespace palpate::program
