// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

namespace palpate::testing {

inline constexpr const char* kCountsAlways = "counts_always";  ///< a property of a test

/// This test fails, and no stall of the machine explains it: it does not run again (docs/decisions/timed_tests.md).
inline void countAlways() {
  ::testing::Test::RecordProperty(kCountsAlways, 1);
}

}  // namespace palpate::testing
