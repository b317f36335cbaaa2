// SPDX-License-Identifier: Apache-2.0
#include "core/data/try_in_child.h"

#include <fcntl.h>
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

}  // namespace

void tryInChild(const std::string& name, std::size_t bytes, const std::function<void()>& work) {
  std::array<int, 2> ends{};
  const bool piped = ::pipe2(ends.data(), O_CLOEXEC) == 0;
  const pid_t child = piped ? ::fork() : -1;
  if (child < 0) {
    const std::string reason = std::strerror(errno);
    if (piped) ::close(ends[0]), ::close(ends[1]);
    throw LoadError(name + ": no process can be started to look at it: " + reason);
  }
  if (child == 0) beChild(ends[1], name, bytes, work);
  ::close(ends[1]);
  const std::string answer = readAll(ends[0]);
  ::close(ends[0]);
  const std::string end = endOf(child);
  if (answer.empty())
    throw LoadError(name + ": the process that had HDF5 look at it ended " + end +
                    ", the file is damaged or made to harm");
  if (answer.front() == kFailed) throw LoadError(answer.substr(1));
}

}  // namespace palpate
