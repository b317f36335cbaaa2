// SPDX-License-Identifier: Apache-2.0
#include "core/data/try_in_child.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
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
  // A server's threads block its signals but for one; here nobody would take them.
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
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

constexpr std::size_t kMostSaid = 16'384;  // bytes; a path and why it is refused are fewer

/// What the child says until it closes its end, at most kMostSaid bytes of it. @throw LoadError when that takes too long
std::string listen(int to, const std::string& name, const Patience& patience) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kLook{100};
  const auto end = Clock::now() + patience.most;
  std::string text;
  std::array<char, 4096> part{};
  while (text.size() < kMostSaid) {
    if (patience.given_up != nullptr && patience.given_up->load())
      throw LoadError(name + ": nobody wants it any more");
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() <= 0)
      throw LoadError(name + ": the process that had HDF5 look at it was not done in " +
                      std::to_string(patience.most.count()) +
                      " ms, the file is made to harm or the machine is too busy");
    pollfd ready{to, POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(std::min(left, kLook).count())) <= 0) continue;
    const ssize_t got = ::read(to, part.data(), std::min(part.size(), kMostSaid - text.size()));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(got));
  }
  return text;
}

/// How a child ended that did not say. One that goes on is killed; how one ended that has is not changed by that.
std::string endOf(pid_t child) {
  int status = 0;
  ::kill(child, SIGKILL);
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return "without a word";
  return WIFSIGNALED(status) ? std::string("by ") + ::strsignal(WTERMSIG(status)) : "without a word";
}

[[noreturn]] void failToStart(const std::string& name, int error) {
  throw LoadError(name + ": no process can be started to look at it: " + std::strerror(error));
}

/// Starts a child that says on the pipe's second end how it went, and hears it.
/// @param start  what starts it, given that end; returns 0 and the child, or errno
void hear(const std::string& name, const Patience& patience,
          const std::function<int(int answer, pid_t& child)>& start) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) failToStart(name, errno);
  pid_t child = -1;
  const int error = start(ends[1], child);
  ::close(ends[1]);
  if (error != 0) {
    ::close(ends[0]);
    failToStart(name, error);
  }
  std::string answer;
  try {
    answer = listen(ends[0], name, patience);
  } catch (...) {
    ::close(ends[0]);
    (void)endOf(child);
    throw;
  }
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

void tryInChild(const std::string& name, std::size_t bytes, const std::function<void()>& work,
                const Patience& patience) {
  hear(name, patience, [&](int answer, pid_t& child) {
    child = ::fork();
    if (child == 0) beChild(answer, name, bytes, work);
    return child < 0 ? errno : 0;
  });
}

void tryInProgram(const std::string& name, std::size_t bytes, const std::string& argument, int descriptor,
                  const Patience& patience) {
  hear(name, patience, [&](int answer, pid_t& child) {
    return spawnSelf({"palpate-model-trial", argument, name, std::to_string(bytes)}, descriptor, answer,
                     child);
  });
}

void answerTrial(const std::string& name, std::size_t bytes, const std::function<void()>& work) {
  ::close_range(kTrialAnswer + 1, ~0U, 0);  // sockets that the program before left open
  beChild(kTrialAnswer, name, bytes, work);
}

}  // namespace palpate
