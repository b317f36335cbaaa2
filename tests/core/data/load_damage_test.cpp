// SPDX-License-Identifier: Apache-2.0
// Files that are no model files, or that were damaged.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <random>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

#include "../load_case.h"

namespace palpate::testing {

namespace {

std::vector<char> readBytes(const std::filesystem::path& path) {
  const std::string bytes = contentOf(path);
  return {bytes.begin(), bytes.end()};
}

void writeBytes(const std::filesystem::path& path, const std::vector<char>& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

struct WrongBytes : LoadCase {
  std::function<void(std::vector<char>&)> spoil;
};

class LoadRefusesBytes : public ::testing::TestWithParam<WrongBytes> {};

TEST_P(LoadRefusesBytes, WithOneClearLine) {
  const TemporaryFile file("bytes.h5");
  modelfile::writeModel(file.path(), goodData());
  std::vector<char> bytes = readBytes(file.path());
  GetParam().spoil(bytes);
  writeBytes(file.path(), bytes);
  expectRefused(file.path(), GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    All, LoadRefusesBytes,
    ::testing::Values(WrongBytes{{"Empty", "is empty, expected a model file"}, [](auto& b) { b.clear(); }},
                      WrongBytes{{"Truncated", "truncated"}, [](auto& b) { b.resize(b.size() / 2); }},
                      WrongBytes{{"TruncatedByOne", "truncated"}, [](auto& b) { b.pop_back(); }},
                      WrongBytes{{"SignatureOnly", "truncated or damaged"}, [](auto& b) { b.resize(8); }},
                      WrongBytes{{"Text", "does not begin with the HDF5 signature"},
                                 [](auto& b) { b = {'s', 'o', 'l', 'i', 'd', ' ', 'x', '\n', '1'}; }},
                      WrongBytes{{"GarbageBehindTheSignature", "truncated or damaged"},
                                 [](auto& b) { std::fill(b.begin() + 8, b.end(), '\xA5'); }}),
    kCaseName);

TEST(Load, RefusesAMissingFileADirectoryAndAPipe) {
  expectRefused("/nonexistent/model.h5", "cannot be opened: No such file or directory");
  expectRefused("/tmp", "is no regular file");
  expectRefused("/dev/null", "is no regular file");
}

TEST(Load, SurvivesDamagedBytes) {
#if defined(__SANITIZE_ADDRESS__)
  const __lsan::ScopedDisabler hdf5_itself_leaks_on_damaged_headers;  // a few hundred bytes, seen with 1.10.8
#endif
  const TemporaryFile file("fuzz.h5");
  modelfile::writeModel(file.path(), goodData());
  const std::vector<char> good = readBytes(file.path());
  std::mt19937 random(7);
  int refused = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<char> bytes = good;
    for (int flips = 0; flips < 4; ++flips) bytes[random() % bytes.size()] = static_cast<char>(random());
    for (int flips = 0; flips < 2; ++flips) bytes[random() % 2048] = static_cast<char>(random());
    writeBytes(file.path(), bytes);
    const std::string text = complaint(file.path());
    refused += text.empty() ? 0 : 1;
    ASSERT_EQ(std::count(text.begin(), text.end(), '\n'), 0) << text;
  }
  EXPECT_GT(refused, 10);
}

}  // namespace palpate::testing
