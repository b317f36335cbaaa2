// SPDX-License-Identifier: Apache-2.0
// Models for which there is not enough memory.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "../load_case.h"
#include "core/data/available_memory.h"

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

/// Of this process, from the kernel: VmRSS or the largest that it was since the count began, VmHWM.
std::uint64_t residentBytes(const std::string& line) {
  std::ifstream status("/proc/self/status");
  std::uint64_t kib = 0;
  for (std::string word; status >> word && kib == 0;)
    if (word == line + ":") status >> kib;
  return 1024 * kib;
}

/// Loads, and says if that took more than one and a half times the file's size of memory: for a death test.
[[maybe_unused, noreturn]] void loadWithin(const std::filesystem::path& path) {
  if (!(std::ofstream("/proc/self/clear_refs") << 5 << std::flush)) std::_Exit(2);  // begins the count
  const std::uint64_t before = residentBytes("VmRSS"), size = std::filesystem::file_size(path);
  std::fputs(complaint(path).c_str(), stderr);
  const std::uint64_t taken = residentBytes("VmHWM") - before;
  if (2 * taken > 3 * size)
    std::fprintf(stderr, "%.0f MiB for a file of %.0f", double(taken) / kMiB, double(size) / kMiB);
  std::_Exit(taken > size ? 0 : 1);  // it holds the file
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
  replaceDataset(file.path(), "mesh/fixed", H5T_STD_I8LE, {32 * kMiB});
  EXPECT_EXIT(loadUnder(RLIMIT_AS, addressSpace() + 128 * kMiB, file.path()), ::testing::ExitedWithCode(0),
              "narrow.h5: a copy of what it has in fewer bytes needs 128 MiB of memory, [0-9]+ MiB are "
              "available .ulimit -v.");
}

TEST(LoadDeathTest, AModelTakesAtMostHalfAsMuchMemoryBesideItsFile) {
  const TemporaryFile file("large.h5");
  modelfile::ModelData data = syntheticModel({.subdivisions = 5, .modes = 200, .near_radius = 0.006});
  data.attributes.patch_radius = 0.003;  // 1.3 edges: 40 nodes in a patch
  modelfile::writeModel(file.path(), data);
  EXPECT_GT(std::filesystem::file_size(file.path()), 64 * kMiB);
  EXPECT_EXIT(loadWithin(file.path()), ::testing::ExitedWithCode(0), "^$");
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

}  // namespace palpate::testing
