// SPDX-License-Identifier: Apache-2.0
// What is left to the process that parses model files.
#include "core/reader/sandbox.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <functional>
#include <new>

#include "../load_case.h"

namespace palpate::testing {

namespace {

constexpr std::size_t kMebibyte = 1U << 20U;

/// Locked down, works and ends; for a death test.
[[noreturn]] void workLockedDown(const std::function<int()>& work, int output = STDERR_FILENO) {
  lockDown(output, 64 * kMebibyte);
  ::_exit(work());
}

struct Forbidden {
  std::string name;
  std::function<void()> work;
};

class LockedDownDeathTest : public ::testing::TestWithParam<Forbidden> {};

TEST_P(LockedDownDeathTest, EndsTheProcess) {
  EXPECT_EXIT(workLockedDown([&] { return GetParam().work(), 0; }), ::testing::KilledBySignal(SIGSYS), "");
}

void* mapped(int protection, int flags, int descriptor) {
  return ::mmap(nullptr, kMebibyte, protection, flags | MAP_PRIVATE, descriptor, 0);
}

std::vector<Forbidden> forbidden() {
  std::vector<Forbidden> all{
      {"ReadsADescriptor",
       [] {
         char byte = 0;
         (void)!::read(STDIN_FILENO, &byte, 1);
       }},
      {"MakesASocket", [] { (void)::socket(AF_INET, SOCK_STREAM, 0); }},
      {"Forks", [] { (void)::fork(); }},
      {"BecomesAnotherProgram", [] { (void)::execl("/bin/true", "true", nullptr); }},
      {"SendsASignal", [] { (void)::kill(::getppid(), SIGTERM); }},
      {"MapsMemoryThatRuns", [] { (void)mapped(PROT_READ | PROT_EXEC, MAP_ANONYMOUS, -1); }},
      {"MapsAFile", [] { (void)mapped(PROT_READ, 0, STDIN_FILENO); }},
      {"RemovesAFile", [] { (void)::unlink("/tmp/palpate-none"); }},
  };
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their runtimes do
  all.push_back({"WritesToAnotherDescriptor", [] { (void)!::write(STDOUT_FILENO, "x", 1); }});
  all.push_back({"LetsMemoryRun", [] { (void)::mprotect(nullptr, kMebibyte, PROT_READ | PROT_EXEC); }});
#endif
  return all;
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(All, LockedDownDeathTest, ::testing::ValuesIn(forbidden()), kCaseName);

TEST(SandboxDeathTest, LeavesMemoryAndAnAnswer) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const auto work = [&] {
    std::vector<double> room(2 * kMebibyte, 1.0);
    room.resize(3 * kMebibyte, 2.0);
    return ::write(ends[1], "done", 4) == 4 && room.back() == 2.0 ? 0 : 1;
  };
  EXPECT_EXIT(workLockedDown(work, ends[1]), ::testing::ExitedWithCode(0), "");
  ::close(ends[1]);
  std::array<char, 4> said{};
  EXPECT_EQ(::read(ends[0], said.data(), said.size()), 4);
  EXPECT_EQ(std::string(said.data(), said.size()), "done");
  ::close(ends[0]);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they take all addresses themselves
TEST(SandboxDeathTest, MoreMemoryThanItsRoomIsNotThere) {
  EXPECT_EXIT(workLockedDown([] {
                try {
                  const std::vector<double> room(10 * kMebibyte);
                  return static_cast<int>(room.front());
                } catch (const std::bad_alloc&) {
                  return 7;
                }
              }),
              ::testing::ExitedWithCode(7), "");
}
#endif

TEST(SandboxDeathTest, NoFileIsOpened) {
  EXPECT_EXIT(workLockedDown([] {
                const bool opened = ::open("/etc/passwd", O_RDONLY | O_CLOEXEC) >= 0;
                return !opened && errno == EACCES ? 7 : 1;
              }),
              ::testing::ExitedWithCode(7), "");
}

/// HDF5 opens what an external link names.
TEST(SandboxDeathTest, HDF5CannotFollowALinkIntoAnotherFile) {
  const TemporaryFolder folder;
  modelfile::writeModel(folder / "other.h5", goodData());
  modelfile::writeModel(folder / "model.h5", goodData());
  {
    const Hdf5Handle file = openForSpoiling(folder / "model.h5");
    H5Lcreate_external((folder / "other.h5").c_str(), "/contact/force", file.get(), "away", H5P_DEFAULT,
                       H5P_DEFAULT);
  }
  const auto follow = [&](const Hdf5Handle& file) {
    return Hdf5Handle(H5Dopen2(file.get(), "away", H5P_DEFAULT), H5Dclose).valid();
  };
  const Hdf5Handle file(H5Fopen((folder / "model.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  EXPECT_TRUE(follow(file)) << "where it may";
  EXPECT_EXIT(workLockedDown([&] { return follow(file) ? 1 : 7; }), ::testing::ExitedWithCode(7), "");
}

}  // namespace palpate::testing
