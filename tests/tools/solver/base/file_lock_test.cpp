// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/file_lock.h"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "palpate/testing/files.h"

namespace palpate::solver {
namespace {

using std::chrono::milliseconds;

TEST(FileLock, IsOfOneAtATime) {
  const testing::TemporaryFolder folder;
  std::optional<FileLock> first = FileLock::take(folder / "lock");
  ASSERT_TRUE(first);
  EXPECT_FALSE(FileLock::take(folder / "lock", milliseconds(0)));
  const FileLock moved(std::move(*first));
  first.reset();
  EXPECT_FALSE(FileLock::take(folder / "lock", milliseconds(0))) << "what was moved from holds nothing";
}

TEST(FileLock, WaitsForOneThatEnds) {
  const testing::TemporaryFolder folder;
  std::optional<FileLock> first = FileLock::take(folder / "lock");
  std::jthread end([&] {
    std::this_thread::sleep_for(milliseconds(150));
    first.reset();
  });
  EXPECT_TRUE(FileLock::take(folder / "lock", milliseconds(60'000)));
}

TEST(FileLock, IsOfTheFileThatHasTheName) {
  const testing::TemporaryFolder folder;
  const std::optional<FileLock> first = FileLock::take(folder / "lock");
  std::filesystem::remove(folder / "lock");  // as who holds it may
  EXPECT_TRUE(FileLock::take(folder / "lock", milliseconds(0)));
}

TEST(FileLock, NeedsAFolderAndAFile) {
  const testing::TemporaryFolder folder;
  EXPECT_FALSE(FileLock::take(folder / "none" / "lock", milliseconds(0)));
  EXPECT_THROW((void)FileLock::take(folder.path(), milliseconds(0)), std::runtime_error);
}

}  // namespace
}  // namespace palpate::solver
