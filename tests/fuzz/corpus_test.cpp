// SPDX-License-Identifier: Apache-2.0
// Files that a fuzzer found, read once more: what crashed a program once is among them.
#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "targets.h"

namespace palpate::fuzz {

void PrintTo(const Target& target, std::ostream* out) {
  *out << target.name;
}

namespace {

std::vector<std::uint8_t> bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Corpus : public ::testing::TestWithParam<Target> {};

TEST_P(Corpus, IsReadOrRefused) {
  const Target& target = GetParam();
  int files = 0, taken = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(PALPATE_FUZZ_CORPUS) / target.name)) {
    ++files;
    const std::vector<std::uint8_t> bytes = bytesOf(entry.path());
    ASSERT_LE(bytes.size(), 2048U) << entry.path() << ": keep the corpus small";
    try {
      taken += target.read(bytes) ? 1 : 0;
    } catch (const std::exception& error) {
      ADD_FAILURE() << entry.path() << ": " << error.what();
    }
    try {
      (void)target.read(Bytes(bytes).first(bytes.size() / 2));  // and cut off
    } catch (const std::exception& error) {
      ADD_FAILURE() << entry.path() << ", half of it: " << error.what();
    }
  }
  EXPECT_GT(files, 0);
  EXPECT_GT(taken, 0) << "all of it is refused: a fuzzer that starts there gets no further";
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, ::testing::ValuesIn(kTargets),
                         [](const auto& tested) { return std::string(tested.param.name); });

// Wrong twins.
bool busy(Bytes) {
  const std::clock_t began = std::clock();
  while (std::clock() - began < CLOCKS_PER_SEC / 20) continue;
  return true;
}
bool waits(Bytes) {
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return true;
}

TEST(FuzzedInput, IsJudgedByProcessorTime) {
  EXPECT_THROW((void)soonEnough(busy, {}, 0.01), std::logic_error);
  EXPECT_TRUE(soonEnough(waits, {}, 0.04));
}

}  // namespace

}  // namespace palpate::fuzz
