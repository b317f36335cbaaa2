// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "palpate/testing/child_process.h"

namespace palpate::testing {
namespace {

// A server's threads write to the same log.
TEST(CaughtOutput, KeepsEveryLineOfThreadsThatWriteAtOnce) {
  static constexpr std::string_view kLine = "a tick ended 2281 us after it was due\n";
  constexpr int kThreads = 2;
  static constexpr std::ptrdiff_t kEach = 20'000;
  const CaughtOutput output;
  std::vector<std::thread> writers;
  for (int i = 0; i < kThreads; ++i)
    writers.emplace_back([&output] {
      for (std::ptrdiff_t k = 0; k < kEach; ++k)
        EXPECT_EQ(::write(output.descriptor(), kLine.data(), kLine.size()), std::ssize(kLine));
    });
  for (std::thread& writer : writers) writer.join();
  const std::string text = output.text();
  EXPECT_EQ(std::ranges::count(text, '\n'), kThreads * kEach);
}

}  // namespace
}  // namespace palpate::testing
