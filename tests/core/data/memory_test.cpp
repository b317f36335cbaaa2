// SPDX-License-Identifier: Apache-2.0
// Models for which there is not enough memory.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "../load_case.h"
#include "core/data/available_memory.h"
#include "core/data/load_error.h"
#include "core/data/try_in_child.h"

namespace palpate::testing {

namespace {

constexpr std::uint64_t kMiB = 1U << 20U;

void write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

void expectAvailable(const TemporaryFolder& root, std::uint64_t bytes, const std::string& limit) {
  const AvailableMemory available = availableMemory(root.path());
  EXPECT_EQ(available.bytes, bytes);
  EXPECT_EQ(available.limit, limit);
}

/// Lowers a limit of this process, loads, and says what happened: for a death test.
[[noreturn]] void loadUnder(__rlimit_resource resource, std::uint64_t bytes,
                            const std::filesystem::path& path) {
  const rlimit limit{bytes, bytes};
  ::setrlimit(resource, &limit);
  std::fputs(complaint(path).c_str(), stderr);
  std::_Exit(0);
}

}  // namespace

TEST(AvailableMemory, IsWhatTheMachineHas) {
  const TemporaryFolder root;
  write(root / "proc/meminfo", "MemTotal: 16 kB\nMemFree: 1 kB\nMemAvailable: 2048 kB\n");
  expectAvailable(root, 2 * kMiB, "the machine");
}

TEST(AvailableMemory, IsNoMoreThanItsControlGroupsLeave) {
  const TemporaryFolder root;
  write(root / "proc/meminfo", "MemAvailable: 1048576 kB\n");
  write(root / "proc/self/cgroup", "4:memory:/pod/one\n3:cpu:/pod\n0::/slice/unit\n");
  const auto two = root / "sys/fs/cgroup/slice", one = root / "sys/fs/cgroup/memory/pod";
  write(two / "unit/memory.max", "max\n");
  write(two / "unit/memory.current", "1\n");
  expectAvailable(root, 1024 * kMiB, "the machine");
  write(two / "memory.max", "104857600\n");  // of the group above
  write(two / "memory.current", "62914560\n");
  write(two / "memory.stat", "anon 5\ninactive_file 20971520\nactive_file 10485760\n");
  expectAvailable(root, 70 * kMiB, "its control group");
  write(one / "one/memory.limit_in_bytes", "52428800\n");
  write(one / "one/memory.usage_in_bytes", "41943040\n");
  write(one / "one/memory.stat", "inactive_file 1\ntotal_inactive_file 10485760\n");
  expectAvailable(root, 20 * kMiB, "its control group");
}

TEST(AvailableMemory, OfAGroupThatIsFullIsNone) {
  const TemporaryFolder root;
  write(root / "proc/self/cgroup", "0::/\n");
  write(root / "sys/fs/cgroup/memory.max", "100\n");
  write(root / "sys/fs/cgroup/memory.current", "200\n");
  expectAvailable(root, 0, "its control group");
}

TEST(Load, AModelLargerThanTheMachineIsNotCopied) {
  const TemporaryFile file("large.h5");
  modelfile::writeModel(file.path(), goodData());
  std::filesystem::resize_file(file.path(), std::uint64_t{1} << 40U);  // a hole: nothing is on the disk
  expectRefused(file.path(), ": its copy needs 1048576 MiB of memory, ");
  expectRefused(file.path(), " MiB are available (");
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they take all addresses themselves
TEST(LoadDeathTest, AModelLargerThanTheAddressSpaceIsRefusedInOneLine) {
  const TemporaryFile file("addresses.h5");
  modelfile::writeModel(file.path(), goodData());
  std::filesystem::resize_file(file.path(), 256 * kMiB);
  EXPECT_EXIT(loadUnder(RLIMIT_AS, addressSpace() + 64 * kMiB, file.path()), ::testing::ExitedWithCode(0),
              "addresses.h5: its copy needs 256 MiB of memory, [0-9]+ MiB are available .ulimit -v.");
}

TEST(LoadDeathTest, TablesLargerThanTheAddressSpaceAreRefusedInOneLine) {
  const TemporaryFile file("tables.h5");
  modelfile::writeModel(file.path(), goodData());
  EXPECT_EXIT(loadUnder(RLIMIT_AS, addressSpace() + 32 * kMiB, file.path()), ::testing::ExitedWithCode(0),
              "tables.h5: what is computed from it needs [0-9]+ MiB of memory, [0-9]+ MiB are available");
}

TEST(LoadDeathTest, NumbersInFewBytesWhoseCopyHasNoRoomAreRefusedInOneLine) {
  const TemporaryFile file("narrow.h5");
  modelfile::writeModel(file.path(), goodData());
  replaceDataset(file.path(), "near/node", H5T_STD_I8LE, {32 * kMiB});
  EXPECT_EXIT(loadUnder(RLIMIT_AS, addressSpace() + 128 * kMiB, file.path()), ::testing::ExitedWithCode(0),
              "narrow.h5: a copy of what it has in fewer bytes needs 128 MiB of memory, [0-9]+ MiB are "
              "available .ulimit -v.");
}

/// A file of 16 MiB in 8 bits whose numbers are wanted in 64, and 32 MiB for what HDF5 takes.
TEST(TryInChild, HasRoomForACopyOfNumbersInFewBytes) {
  EXPECT_NO_THROW(tryInChild("model.h5", 16 * kMiB, [] {
    std::vector<double> copy(16 * kMiB), rest(4 * kMiB);
    copy.back() = rest.back() = 1.0;
  }));
  EXPECT_THROW(tryInChild("model.h5", 16 * kMiB, [] { std::vector<double> copy(32 * kMiB); }), LoadError);
}
#endif

TEST(LoadDeathTest, AModelLargerThanFilesMayBeIsRefusedInOneLine) {
  const TemporaryFile file("filesize.h5");
  modelfile::writeModel(file.path(), goodData());
  std::filesystem::resize_file(file.path(), 4 * kMiB);
  EXPECT_EXIT(loadUnder(RLIMIT_FSIZE, 2 * kMiB, file.path()), ::testing::ExitedWithCode(0),
              "filesize.h5: its copy needs 4 MiB of memory, 2 MiB are available .ulimit -f.");
}

TEST(LoadDeathTest, AModelWhoseCopyFitsIsNotRefusedForItsTablesWhichAreNoFile) {
  const TemporaryFile file("copyfits.h5");
  modelfile::writeModel(file.path(), goodData());
  EXPECT_EXIT(loadUnder(RLIMIT_FSIZE, 2 * kMiB, file.path()), ::testing::ExitedWithCode(0), "^$");
}

/// What tryInChild() says of it; empty: nothing.
std::string complaintOf(const std::function<void()>& work, const Patience& patience = {}) {
  try {
    tryInChild("model.h5", 0, work, patience);
    return {};
  } catch (const LoadError& error) {
    return error.what();
  }
}

TEST(TryInChild, NamesTheFileWhateverIsThrown) {
  EXPECT_EQ(complaintOf([] { throw std::runtime_error("no room"); }), "model.h5: no room");
  EXPECT_EQ(complaintOf([] { throw LoadError("model.h5: is damaged"); }), "model.h5: is damaged");
}

TEST(TryInChild, IsNotWaitedForWithoutEnd) {
  using std::chrono::milliseconds;
  const auto before = std::chrono::steady_clock::now();
  EXPECT_EQ(complaintOf([] { ::sleep(600); }, {.most = milliseconds(200)}),
            "model.h5: the process that had HDF5 look at it was not done in 200 ms, the file is made to harm "
            "or the "
            "machine is too busy");
  EXPECT_EQ(complaintOf([] { ::kill(::getpid(), SIGSTOP); }, {.most = milliseconds(200)})
                .find("model.h5: the process"),
            0U);
  const std::atomic<bool> given_up{true};
  EXPECT_EQ(complaintOf([] { ::sleep(600); }, {.given_up = &given_up}), "model.h5: nobody wants it any more");
  EXPECT_EQ(
      complaintOf([] {
        ::close_range(3, ~0U, 0);  // the answer's end with them
        ::sleep(600);
      }),
      "model.h5: the process that had HDF5 look at it ended by Killed, the file is damaged or made to harm");
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(20));
  EXPECT_LT(::waitpid(-1, nullptr, WNOHANG), 0) << "none is left";
}

TEST(TryInChild, OfAnEndlessAnswerTheBeginningIsRead) {
  const std::string complaint = complaintOf([] { throw LoadError(std::string(1'000'000, 'x')); });
  EXPECT_EQ(complaint.size(), 16'383U);
}

TEST(TryInChild, HearsSignalsThatAreBlockedHere) {
  sigset_t term, before;
  ::sigemptyset(&term);
  ::sigaddset(&term, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &term, &before);
  const std::string complaint = complaintOf([] { ::raise(SIGTERM); });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  EXPECT_NE(complaint.find("ended by Terminated"), std::string::npos) << complaint;
}

}  // namespace palpate::testing
