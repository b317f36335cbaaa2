// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::modelfile {

/// How far people press where nobody says it, m: soft organs further. @param E  Pa
[[nodiscard]] constexpr double defaultTravel(double E) noexcept {
  constexpr double kSoft = 50e3;  // Pa
  return E < kSoft ? 0.007 : 0.005;
}

}  // namespace palpate::modelfile
