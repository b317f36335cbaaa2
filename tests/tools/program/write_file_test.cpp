// SPDX-License-Identifier: Apache-2.0
#include "tools/program/write_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <iterator>

#include "palpate/testing/files.h"
#include "tools/program/exit_code.h"

namespace palpate::program {
namespace {

class WriteFile : public ::testing::Test {
 protected:
  [[nodiscard]] std::string content(const char* name) const { return testing::contentOf(folder_ / name); }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
  }

  const testing::TemporaryFolder folder_;
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

TEST_F(WriteFile, ChecksBeforeTheWorkWhetherItCan) {
  const auto refusalOf = [](const std::filesystem::path& file) {
    try {
      checkWritable(file);
    } catch (const WriteError& error) {
      return error.reason();
    }
    return std::string();
  };
  EXPECT_EQ(refusalOf(folder_ / "a.txt"), "");
  EXPECT_EQ(refusalOf("a_file_of_the_working_directory.txt"), "");
  EXPECT_EQ(refusalOf(folder_ / "missing" / "a.txt"), "No such file or directory");
  EXPECT_EQ(refusalOf(folder_.path()), "Is a directory");
  EXPECT_EQ(entries(), 0U);
}

TEST_F(WriteFile, RefusesAnOptionWhosePlaceCannotBeWritten) {
  const auto refusalOf = [](auto check, const std::filesystem::path& place) {
    try {
      check("--plot", place);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::filesystem::path nowhere = folder_ / "missing" / "a.svg", file = folder_ / "b.svg";
  EXPECT_EQ(refusalOf(checkOutput, ""), "");
  EXPECT_EQ(refusalOf(checkOutput, folder_ / "a.svg"), "");
  EXPECT_EQ(refusalOf(checkOutput, nowhere),
            "--plot: cannot write " + nowhere.string() + ": No such file or directory");
  EXPECT_EQ(refusalOf(checkOutput, folder_.path()),
            "--plot: cannot write " + folder_.path().string() + ": Is a directory");
  writeFile(file, std::string("b"));
  EXPECT_EQ(refusalOf(checkOutput, file), "") << "it takes the place of the old one";
  EXPECT_EQ(refusalOf(checkOutputFolder, folder_.path()), "");
  EXPECT_EQ(refusalOf(checkOutputFolder, folder_ / "new" / ""), "") << "it is made";
  EXPECT_EQ(refusalOf(checkOutputFolder, nowhere), "") << "its parent is made too";
  EXPECT_EQ(refusalOf(checkOutputFolder, file / "c" / "d"),
            "--plot: cannot write " + (file / "c" / "d").string() + ": Not a directory");
  EXPECT_EQ(refusalOf(checkOutputFolder, file),
            "--plot: cannot write " + file.string() + ": Not a directory");
}

TEST_F(WriteFile, KnowsOneFileByAllItsPaths) {
  const std::filesystem::path file = folder_ / "a.txt", link = folder_ / "link";
  EXPECT_TRUE(isSameFile(file, folder_.path() / "." / "a.txt"));  // not there yet
  EXPECT_TRUE(isSameFile("b.txt", std::filesystem::current_path() / "b.txt"));
  writeFile(file, std::string("a"));
  std::filesystem::create_symlink(file, link);
  EXPECT_TRUE(isSameFile(file, link));
  EXPECT_FALSE(isSameFile(file, folder_ / "b.txt"));
  writeFile(folder_ / "b.txt", std::string("a"));
  EXPECT_FALSE(isSameFile(file, folder_ / "b.txt"));
}

}  // namespace
}  // namespace palpate::program
