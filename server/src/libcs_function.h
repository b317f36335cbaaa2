// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlfcn.h>

#include <cstring>

namespace palpate::server {

/// The function of libc in whose place this program has one of its own. Real-time: no.
template <class Function>
[[nodiscard]] Function* libcsFunction(const char* name) noexcept {
  void* const found = dlsym(RTLD_NEXT, name);
  Function* function = nullptr;
  static_assert(sizeof found == sizeof function);
  std::memcpy(&function, &found, sizeof found);
  return function;
}

}  // namespace palpate::server
