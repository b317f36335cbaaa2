// SPDX-License-Identifier: Apache-2.0
#include "core/data/ask_reader.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <sysexits.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <thread>
#include <vector>

#include "core/data/descriptor.h"
#include "core/data/load_error.h"
#include "core/data/sealed_image.h"

namespace palpate {

namespace {

namespace fs = std::filesystem;

// Bytes; a provenance may hold a whole case file, which is there several times in the 64 MiB that the process has.
constexpr std::size_t kMostSaid = 8U << 20U;

[[noreturn]] void failToStart(const std::string& name, const std::string& program, int error) {
  throw LoadError(name + ": no process can be started to parse it, " + program + ": " + std::strerror(error));
}

/// That of this installation or build. @throw LoadError  nothing says where this program is, and a relative path would be looked
/// for in the working directory
std::string readerProgram(const std::string& name) {
  std::error_code failure;
  const fs::path self = fs::read_symlink("/proc/self/exe", failure);
  if (failure) failToStart(name, "/proc/self/exe", failure.value());
  const std::optional<fs::path> program = readerOf(self);
  if (!program) failToStart(name, self.string(), ENOENT);
  return program->string();
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
    const Descriptor far_image(::fcntl(image, F_DUPFD_CLOEXEC, kFirstFree));
    const Descriptor far_answer(::fcntl(answer, F_DUPFD_CLOEXEC, kFirstFree));
    if (far_image.get() < 0 || far_answer.get() < 0) return errno;
    if (const int error = prepare(far_image.get(), far_answer.get()); error != 0) return error;
    std::string called = program;
    const std::array<char*, 2> arguments{called.data(), nullptr};
    const std::array<char*, 1> variables{nullptr};
    return ::posix_spawn(&child, program.c_str(), &actions_, &attributes_, arguments.data(),
                         variables.data());
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

/// For how long a process is waited for.
class Patience {
 public:
  Patience(const std::string& name, const ReaderProcess& process)
      : name_(name), process_(process), end_(Clock::now() + process.most) {}

  /// @return how long to wait until this is asked again, not above `most`. @throw LoadError  it took too long, or is not wanted
  [[nodiscard]] std::chrono::milliseconds left(std::chrono::milliseconds most) const {
    if (process_.given_up != nullptr && process_.given_up->load())
      throw LoadError(name_ + ": nobody wants it any more");
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end_ - Clock::now());
    if (left.count() <= 0)
      throw LoadError(name_ + ": the process that parses it was not done in " +
                      std::to_string(process_.most.count()) +
                      " ms, the file is made to harm or the machine is too busy");
    return std::min(left, most);
  }

 private:
  using Clock = std::chrono::steady_clock;
  const std::string& name_;
  const ReaderProcess& process_;
  Clock::time_point end_;
};

/// A process that ends with its scope at the latest.
class Child {
 public:
  explicit Child(pid_t id) noexcept : id_(id) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (id_ < 0 || ::waitpid(id_, nullptr, WNOHANG) != 0) return;
    ::kill(id_, SIGKILL);
    while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) continue;
  }

  /// Waits for its end: one that has closed its output may not have come to it. @return as of waitpid(); none: it is not known
  [[nodiscard]] std::optional<int> end(const Patience& patience) {
    constexpr std::chrono::milliseconds kLook{1};
    for (int status = 0;;) {
      const pid_t ended = ::waitpid(id_, &status, WNOHANG);
      if (ended < 0 && errno == EINTR) continue;
      if (ended != 0) id_ = -1;
      if (ended != 0) return ended < 0 ? std::nullopt : std::optional(status);
      std::this_thread::sleep_for(patience.left(kLook));
    }
  }

 private:
  pid_t id_;
};

/// What a process says until it closes its end. @throw LoadError when that takes too long, or too much is said
std::string answerFrom(int end, const std::string& name, const Patience& patience) {
  constexpr std::chrono::milliseconds kLook{100};
  std::string text;
  std::vector<char> part(std::size_t{1} << 16U);
  for (;;) {
    pollfd ready{end, POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(patience.left(kLook).count())) <= 0) continue;
    const ssize_t got = ::read(end, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(part.data(), static_cast<std::size_t>(got));
    if (text.size() > kMostSaid)
      throw LoadError(name + ": the process that parses it says more than " +
                      std::to_string(kMostSaid >> 20U) + " MiB, the file is made to harm");
  }
}

/// What is wrong with how a process ended, and whose fault it is; empty: nothing.
std::string complaintOf(std::optional<int> end) {
  constexpr int kNotLoaded = 127;  // of ld.so: a library is missing, or has no room
  const std::string cannot = "palpate-read-model cannot run here, ";
  const std::string ended = "the process that parses it ended ",
                    harm = ", the file is damaged or made to harm";
  if (!end) return cannot + "this program does not hear how it ends: SIGCHLD is ignored";
  if (WIFSIGNALED(*end)) return ended + "by " + ::strsignal(WTERMSIG(*end)) + harm;
  switch (const int code = WEXITSTATUS(*end); code) {
    case 0:
      return "";
    case kNotLoaded:
      return cannot + "one of its libraries is missing or has no room (ulimit -v)";
    case EX_OSERR:
      return cannot + "the file's copy cannot be mapped (ulimit -v)";
    default:
      return ended + "with exit code " + std::to_string(code) + harm;
  }
}

}  // namespace

std::optional<fs::path> readerOf(const fs::path& self) {
  if (!self.is_absolute()) return std::nullopt;
  const auto in = [&](const char* folder) {
    return (self.parent_path() / folder / "palpate-read-model").lexically_normal();
  };
  std::error_code failure;
  for (const char* folder : {PALPATE_READER_FROM_BIN, ".",
                             "../bin"})  // the last ones of a build or a copy of it, and of its tests
    if (fs::exists(in(folder), failure)) return in(folder);
  return in(PALPATE_READER_FROM_BIN);
}

std::string askReader(const SealedImage& image, const std::string& name, const ReaderProcess& process) {
  const std::string program = process.program.empty() ? readerProgram(name) : process.program.string();
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) failToStart(name, program, errno);
  const Descriptor from(ends[0]);
  pid_t id = -1;
  {
    const Descriptor to(ends[1]);
    if (const int error = Spawn().start(program, image.descriptor(), to.get(), id); error != 0)
      failToStart(name, program, error);
  }
  Child child(id);
  const Patience patience(name, process);
  std::string answer = answerFrom(from.get(), name, patience);
  if (const std::string complaint = complaintOf(child.end(patience)); !complaint.empty())
    throw LoadError(name + ": " + complaint);
  return answer;
}

}  // namespace palpate
