// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

namespace palpate::testing {

inline constexpr const char* kCountsAlways = "counts_always";  ///< a property of a test

/// Beside a failure that no stall of the machine explains: the test does not run again (docs/decisions/timed_tests.md).
inline void countAlways() {
  ::testing::Test::RecordProperty(kCountsAlways, 1);
}

}  // namespace palpate::testing
