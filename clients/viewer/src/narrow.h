// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace palpate::viewer {

/// @param v  three numbers  @return them in the precision that a page gets
template <class Vector>
[[nodiscard]] std::array<float, 3> narrow(const Vector& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}  // namespace palpate::viewer
