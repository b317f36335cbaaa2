// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "palpate/testing/run_program.h"

namespace palpate::testing {

/// Whether the machine let palpate-device not judge or not end its run; any other failure of it fails the test.
inline bool stoodStill(const ProgramResult& result) {
  if (result.exit_code != 1) return false;
  const auto says = [&](const char* part) { return result.err.find(part) != std::string::npos; };
  EXPECT_TRUE(says("stood still too often") || says("has not answered for a second")) << result.err;
  return true;
}

}  // namespace palpate::testing
