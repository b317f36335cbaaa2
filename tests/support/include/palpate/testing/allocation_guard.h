// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

// Whether a sanitizer has taken malloc over: gcc says so in a macro, clang answers a question.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PALPATE_SANITIZER_HAS_MALLOC 1
#elif defined(__has_feature)
#define PALPATE_SANITIZER_HAS_MALLOC \
  (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(realtime_sanitizer))
#else
#define PALPATE_SANITIZER_HAS_MALLOC 0
#endif

namespace palpate::testing {

/// Counts what this thread allocates while a guard lives: operator new in every build, malloc and its family
/// too where no sanitizer has taken them over. Linking palpate_allocation_guard replaces those functions in
/// the whole program.
class AllocationGuard {
 public:
  AllocationGuard() noexcept;
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;
  ~AllocationGuard();
  /// Allocations and frees since the guard was made.
  [[nodiscard]] std::size_t count() const noexcept;
};

}  // namespace palpate::testing
