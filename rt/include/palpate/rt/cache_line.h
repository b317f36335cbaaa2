// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace palpate::rt {

/// What two threads write lies at least this far apart, bytes. Fixed here because the compiler's own constant
/// changes with -mtune, and with it the layout of everything shared.
inline constexpr std::size_t kCacheLine = 64;

}  // namespace palpate::rt
