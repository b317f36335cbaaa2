// SPDX-License-Identifier: Apache-2.0
#include "core/data/ask_reader.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <vector>

#include "core/data/load_error.h"
#include "core/data/sealed_image.h"

namespace palpate {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSaid = 16U << 20U;  // bytes; a provenance may hold a whole case file

/// Beside what is installed, beside a program of a build, and from a test of it.
fs::path readerProgram() {
  std::error_code failure;
  const fs::path bin = fs::read_symlink("/proc/self/exe", failure).parent_path();
  for (const char* folder : {PALPATE_READER_FROM_BIN, ".", "../bin"})
    if (fs::path path = (bin / folder / "palpate-read-model").lexically_normal(); fs::exists(path, failure))
      return path;
  return (bin / PALPATE_READER_FROM_BIN / "palpate-read-model").lexically_normal();
}

[[noreturn]] void failToStart(const std::string& name, const std::string& program, int error) {
  throw LoadError(name + ": no process can be started to parse it, " + program + ": " + std::strerror(error));
}

/// What a child is started with: the copy as its input, the pipe's second end as its output, and nothing else.
class Spawn {
 public:
  Spawn() {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawnattr_init(&attributes_);
  }
  Spawn(const Spawn&) = delete;
  Spawn& operator=(const Spawn&) = delete;
  ~Spawn() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::posix_spawnattr_destroy(&attributes_);
  }

  /// posix_spawn() shares this process's memory with the child until that has become another program.
  [[nodiscard]] int start(const std::string& program, int image, int answer, pid_t& child) {
    // Away from the three places first: either may be where another is to go.
    const int far_image = ::fcntl(image, F_DUPFD_CLOEXEC, kFirstFree);
    const int far_answer = ::fcntl(answer, F_DUPFD_CLOEXEC, kFirstFree);
    int error = far_image < 0 || far_answer < 0 ? errno : prepare(far_image, far_answer);
    std::string called = program;
    const std::array<char*, 2> arguments{called.data(), nullptr};
    const std::array<char*, 1> variables{nullptr};
    if (error == 0)
      error =
          ::posix_spawn(&child, program.c_str(), &actions_, &attributes_, arguments.data(), variables.data());
    for (const int descriptor : {far_image, far_answer})
      if (descriptor >= 0) ::close(descriptor);
    return error;
  }

 private:
  static constexpr int kFirstFree = 3;

  /// What a crashing library writes about itself is no line of ours. Signals are as a program expects them: a server's threads
  /// block those that end it. @return 0, or errno
  [[nodiscard]] int prepare(int image, int answer) {
    sigset_t none, all;
    ::sigemptyset(&none);
    ::sigfillset(&all);
    ::posix_spawnattr_setsigmask(&attributes_, &none);
    ::posix_spawnattr_setsigdefault(&attributes_, &all);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    int error = ::posix_spawn_file_actions_adddup2(&actions_, image, STDIN_FILENO);
    if (error == 0) error = ::posix_spawn_file_actions_adddup2(&actions_, answer, STDOUT_FILENO);
    if (error == 0)
      error = ::posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    if (error == 0) error = ::posix_spawn_file_actions_addclosefrom_np(&actions_, kFirstFree);
    return error;
  }

  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

/// What the child says until it closes its end. @throw LoadError when that takes too long, or too much is said
std::string listen(int to, const std::string& name, const ReaderProcess& process) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kLook{100};
  const auto end = Clock::now() + process.most;
  std::string text;
  std::vector<char> part(std::size_t{1} << 16U);
  for (;;) {
    if (process.given_up != nullptr && process.given_up->load())
      throw LoadError(name + ": nobody wants it any more");
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() <= 0)
      throw LoadError(name + ": the process that parses it was not done in " +
                      std::to_string(process.most.count()) +
                      " ms, the file is made to harm or the machine is too busy");
    pollfd ready{to, POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(std::min(left, kLook).count())) <= 0) continue;
    const ssize_t got = ::read(to, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(part.data(), static_cast<std::size_t>(got));
    if (text.size() > kMostSaid)
      throw LoadError(name + ": the process that parses it says more than " +
                      std::to_string(kMostSaid >> 20U) + " MiB, the file is made to harm");
  }
}

/// How a child ended; empty: as it should. One that goes on is killed; how one ended that has is not changed by that.
std::string endOf(pid_t child) {
  int status = 0;
  ::kill(child, SIGKILL);
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return "and nobody knows how";
  if (WIFSIGNALED(status)) return std::string("by ") + ::strsignal(WTERMSIG(status));
  return WEXITSTATUS(status) == 0 ? "" : "with exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

std::string askReader(const SealedImage& image, const std::string& name, const ReaderProcess& process) {
  const std::string program = (process.program.empty() ? readerProgram() : process.program).string();
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) failToStart(name, program, errno);
  pid_t child = -1;
  const int error = Spawn().start(program, image.descriptor(), ends[1], child);
  ::close(ends[1]);
  if (error != 0) {
    ::close(ends[0]);
    failToStart(name, program, error);
  }
  std::string answer;
  try {
    answer = listen(ends[0], name, process);
  } catch (...) {
    ::close(ends[0]);
    (void)endOf(child);
    throw;
  }
  ::close(ends[0]);
  if (const std::string end = endOf(child); !end.empty())
    throw LoadError(name + ": the process that parses it ended " + end +
                    ", the file is damaged or made to harm");
  return answer;
}

}  // namespace palpate
