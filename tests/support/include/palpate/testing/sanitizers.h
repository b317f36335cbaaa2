// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <vector>

namespace palpate::testing {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// All cases; under a sanitizer the first `few` of them. A sanitizer looks for faults of memory and threads, which one case
/// shows as well as ten, and takes 20 to 50 times as long; the physics of all cases is judged in release.
template <class T>
[[nodiscard]] std::vector<T> fewUnderSanitizers(std::size_t few, std::initializer_list<T> cases) {
  std::vector<T> chosen(cases);
  if (kSanitized) chosen.resize(std::min(few, chosen.size()));
  return chosen;
}

}  // namespace palpate::testing
