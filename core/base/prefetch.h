// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/base/types.h"

namespace palpate {

/// Asks for memory that is read soon, so that the processor's cache fills while other things are done. Real-time: yes.
inline void prefetch(const void* from, std::size_t bytes) noexcept PALPATE_NONBLOCKING {
  constexpr std::size_t kLine = 64;
  const auto* const first = static_cast<const char*>(from);
  if (bytes == 0) return;
  for (std::size_t i = 0; i < bytes; i += kLine) __builtin_prefetch(first + i);
  __builtin_prefetch(first + bytes - 1);
}

template <typename T>
void prefetch(const T& object) noexcept PALPATE_NONBLOCKING {
  prefetch(&object, sizeof(T));
}

}  // namespace palpate
