// SPDX-License-Identifier: Apache-2.0
#include "core/data/try_in_child.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>

#include "core/data/available_memory.h"
#include "core/data/load_error.h"

namespace palpate {

namespace {

constexpr char kDone = 'D', kFailed = 'F';  // first byte of what the child says
constexpr int kTrialAnswer = kTrialImage + 1;

void setLimits([[maybe_unused]] std::size_t bytes) {
  [[maybe_unused]] constexpr rlim_t kSeconds = 10, kRoom = 64U << 20U;
  const rlimit seconds{kSeconds, kSeconds + 1}, core{0, 0};
  ::setrlimit(RLIMIT_CPU, &seconds);
  ::setrlimit(RLIMIT_CORE, &core);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they take all addresses themselves
  const rlim_t addresses = addressSpace() + kRoom + 8 * bytes;       // of 8 bits, as 64
  rlimit now{};
  if (::getrlimit(RLIMIT_AS, &now) != 0 || now.rlim_cur <= addresses) return;
  const rlimit lower{addresses, addresses};
  ::setrlimit(RLIMIT_AS, &lower);
#endif
}

[[noreturn]] void beChild(int answer, const std::string& name, std::size_t bytes,
                          const std::function<void()>& work) {
  setLimits(bytes);
  std::string text(1, kDone);
  try {
    work();
  } catch (const LoadError& error) {  // says which file
    text = kFailed + std::string(error.what());
  } catch (const std::exception& error) {
    text = kFailed + name + ": " + error.what();
  }
  const bool said = ::write(answer, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  ::_exit(said ? 0 : 1);
}

std::string readAll(int from) {
  std::string text;
  std::array<char, 4096> part{};
  for (;;) {
    const ssize_t got = ::read(from, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(part.data(), static_cast<std::size_t>(got));
  }
}

/// How a child ended that did not say.
std::string endOf(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return "without a word";
  return WIFSIGNALED(status) ? std::string("by ") + ::strsignal(WTERMSIG(status)) : "without a word";
}

[[noreturn]] void failToStart(const std::string& name, int error) {
  throw LoadError(name + ": no process can be started to look at it: " + std::strerror(error));
}

/// Starts a child that says on the pipe's second end how it went, and hears it.
/// @param start  what starts it, given that end; returns 0 and the child, or errno
void hear(const std::string& name, const std::function<int(int answer, pid_t& child)>& start) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) failToStart(name, errno);
  pid_t child = -1;
  const int error = start(ends[1], child);
  ::close(ends[1]);
  if (error != 0) {
    ::close(ends[0]);
    failToStart(name, error);
  }
  const std::string answer = readAll(ends[0]);
  ::close(ends[0]);
  const std::string end = endOf(child);
  if (answer.empty())
    throw LoadError(name + ": the process that had HDF5 look at it ended " + end +
                    ", the file is damaged or made to harm");
  if (answer.front() == kFailed) throw LoadError(answer.substr(1));
}

/// posix_spawn() shares this process's memory with the child until that has become another program: nothing is copied.
int spawnSelf(std::array<std::string, 4> arguments, int image, int answer, pid_t& child) {
  std::array<char*, 5> argv{};
  for (std::size_t i = 0; i < arguments.size(); ++i) argv[i] = arguments[i].data();
  posix_spawn_file_actions_t actions;
  if (const int error = ::posix_spawn_file_actions_init(&actions); error != 0) return error;
  // Away from the two places first: either may be where the other is to go.
  const int far_image = ::fcntl(image, F_DUPFD_CLOEXEC, kTrialAnswer + 1);
  const int far_answer = ::fcntl(answer, F_DUPFD_CLOEXEC, kTrialAnswer + 1);
  int error = far_image < 0 || far_answer < 0 ? errno : 0;
  if (error == 0) error = ::posix_spawn_file_actions_adddup2(&actions, far_image, kTrialImage);
  if (error == 0) error = ::posix_spawn_file_actions_adddup2(&actions, far_answer, kTrialAnswer);
  if (error == 0) error = ::posix_spawn(&child, "/proc/self/exe", &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  for (const int descriptor : {far_image, far_answer})
    if (descriptor >= 0) ::close(descriptor);
  return error;
}

}  // namespace

void tryInChild(const std::string& name, std::size_t bytes, const std::function<void()>& work) {
  hear(name, [&](int answer, pid_t& child) {
    child = ::fork();
    if (child == 0) beChild(answer, name, bytes, work);
    return child < 0 ? errno : 0;
  });
}

void tryInProgram(const std::string& name, std::size_t bytes, const std::string& argument, int descriptor) {
  hear(name, [&](int answer, pid_t& child) {
    return spawnSelf({"palpate-model-trial", argument, name, std::to_string(bytes)}, descriptor, answer,
                     child);
  });
}

void answerTrial(const std::string& name, std::size_t bytes, const std::function<void()>& work) {
  ::close_range(kTrialAnswer + 1, ~0U, 0);  // sockets that the program before left open
  beChild(kTrialAnswer, name, bytes, work);
}

}  // namespace palpate
