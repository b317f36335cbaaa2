// SPDX-License-Identifier: Apache-2.0
#include "palpate/program/write_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

namespace palpate::program {
namespace {

// A folder of its own, gone at the end.
class WriteFile : public testing::Test {
 protected:
  WriteFile() { std::filesystem::create_directories(folder_); }
  ~WriteFile() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string content(const char* name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

  const std::filesystem::path folder_{std::filesystem::temp_directory_path() /
                                      ("palpate-write-" + std::to_string(getpid()))};
};

TEST_F(WriteFile, ReplacesTheOldFileByTheNewOne) {
  writeFile(folder_ / "a.txt", std::string("old"));
  writeFile(folder_ / "a.txt", [](std::ostream& out) { out << "new"; });
  EXPECT_EQ(content("a.txt"), "new");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(WriteFile, LeavesTheOldFileWhereTheNewOneFails) {
  writeFile(folder_ / "a.txt", std::string("old"));
  const auto fail = [](std::ostream&) { throw std::runtime_error("no more"); };
  EXPECT_THROW(writeFile(folder_ / "a.txt", fail), std::runtime_error);
  EXPECT_EQ(content("a.txt"), "old");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(WriteFile, NamesTheTargetAndTheReason) {
  const auto refusal = [](const std::filesystem::path& path) -> std::string {
    try {
      writeFile(path, std::string("text"));
    } catch (const WriteError& error) {
      return error.what();
    }
    return "written";
  };
  const std::filesystem::path nowhere = folder_ / "none/a.txt";
  EXPECT_EQ(refusal(nowhere), "cannot write " + nowhere.string() + ": No such file or directory");
  std::filesystem::create_directory(folder_ / "taken");
  EXPECT_EQ(refusal(folder_ / "taken"), "cannot write " + (folder_ / "taken").string() + ": Is a directory");
  const std::string beside = "full.txt.tmp-" + std::to_string(getpid());
  std::filesystem::create_symlink("/dev/full", folder_ / beside);
  EXPECT_EQ(refusal(folder_ / "full.txt"),
            "cannot write " + (folder_ / "full.txt").string() + ": No space left on device");
  EXPECT_EQ(entries(), 1U);  // the folder
}

}  // namespace
}  // namespace palpate::program
