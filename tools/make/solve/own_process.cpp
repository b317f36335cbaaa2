// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/own_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/data/descriptor.h"
#include "tools/program/exit_code.h"

namespace palpate::solve_program {

namespace {

using program::Json;

[[noreturn]] void failToStart() {
  throw std::runtime_error("no process can be started: " + std::string(std::strerror(errno)));
}

bool writeAll(int end, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(end, text.data(), text.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

std::string readAll(int end) {
  std::string text;
  std::array<char, 4096> part{};
  for (;;) {
    const ssize_t got = read(end, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(part.data(), static_cast<std::size_t>(got));
  }
}

/// The process's part. It leaves what the other one has to end, its streams among it, alone: an exception ends it here.
[[noreturn]] void runChild(pid_t parent, int end, const std::function<Json()>& work) noexcept {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(program::kFailed);  // it ended before it could be followed
  const bool said = writeAll(end, work().dump());
  _exit(said ? program::kDone : program::kFailed);
}

int endOf(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) failToStart();
  return status;
}

/// How a process ended that did not say what came out.
std::string complaintOf(int status) {
  if (!WIFSIGNALED(status)) return "its process ended with exit code " + std::to_string(WEXITSTATUS(status));
  const int number = WTERMSIG(status);
  return "its process was ended by signal " + std::to_string(number) + ", " + strsignal(number) +
         (number == SIGKILL ? ": was there too little memory?" : "");
}

}  // namespace

Json inOwnProcess(const std::function<Json()>& work) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) failToStart();
  const Descriptor in(ends[0]);
  std::optional<Descriptor> out(ends[1]);
  std::cout.flush();
  std::fflush(nullptr);  // else both would write what waits
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) failToStart();
  if (child == 0) runChild(parent, out->get(), work);
  out.reset();
  const std::string text = readAll(in.get());
  const int status = endOf(child);
  std::optional<Json> said = Json::read(text);
  if (status != 0 || !said) throw std::runtime_error(complaintOf(status));
  return *said;
}

}  // namespace palpate::solve_program
