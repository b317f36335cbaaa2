// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

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
