// SPDX-License-Identifier: Apache-2.0
// The C++ interface as installed, from C++17.
#include <palpate/haptic/haptic_tool.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

namespace {

int expect(bool holds, const char* what) {
  if (!holds) std::fprintf(stderr, "failed: %s\n", what);
  return holds ? 0 : 1;
}

bool isRefused(const palpate::haptic::Options& options, const char* why) {
  try {
    const palpate::haptic::HapticTool tool(options);
    return false;
  } catch (const palpate::haptic::HapticError& error) {
    return std::strcmp(error.what(), why) == 0;
  }
}

}  // namespace

int main() {
  palpate::haptic::Options options;
  options.domain = 300;
  int failures = expect(isRefused(options, "domain is 300, expected 0 to 230"), "domain 300 is refused");
  options.domain = 217;
  options.force_limit = 3.3;
  palpate::haptic::HapticTool opened(options);
  palpate::haptic::HapticTool tool(std::move(opened));
  failures += expect(!tool.waitForServer(std::chrono::milliseconds(50)), "no server");
  failures += expect(tool.send({0.0, 0.0, 0.1}) != 0, "a pose is sent");
  const palpate::haptic::Force force = tool.forceAt({0.0, 0.0, 0.1});
  failures += expect(std::isinf(force.age_s) && force.gain == 0.0 && force.force[2] == 0.0, "no force");
  return failures;
}
