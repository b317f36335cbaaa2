// SPDX-License-Identifier: Apache-2.0
#include "palpate/testing/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "palpate/testing/paths.h"

extern char** environ;

namespace palpate::testing {

ChildProcess::ChildProcess(const std::string& program, std::vector<std::string> arguments,
                           const Streams& streams, Kills kills) {
  const std::string path = program.find('/') == std::string::npos ? binDir() + "/" + program : program;
  std::string name = program;
  std::vector<char*> argv{name.data()};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (streams.out >= 0) posix_spawn_file_actions_adddup2(&actions, streams.out, STDOUT_FILENO);
  if (streams.err >= 0) posix_spawn_file_actions_adddup2(&actions, streams.err, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  if (kills == Kills::kGroup) posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int failure = posix_spawn(&pid_, path.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw std::runtime_error("cannot start " + path + ": " + std::strerror(failure));
  if (kills == Kills::kGroup) group_ = pid_;
}

ChildProcess::~ChildProcess() {
  if (group_ > 0) kill(-group_, SIGKILL);
  if (!running()) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void ChildProcess::ended(int status) noexcept {
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  pid_ = -1;
}

bool ChildProcess::running() {
  int status = 0;
  if (pid_ > 0 && waitpid(pid_, &status, WNOHANG) == pid_) ended(status);
  return pid_ > 0;
}

void ChildProcess::signal(int number) const {
  if (pid_ > 0) kill(pid_, number);
}

int ChildProcess::waitForExit(std::chrono::seconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (running() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return exit_code_;
}

int ChildProcess::waitForExit() {
  int status = 0;
  if (pid_ > 0 && waitpid(pid_, &status, 0) == pid_) ended(status);
  return exit_code_;
}

CaughtOutput::CaughtOutput() : descriptor_(memfd_create("palpate-test-output", MFD_CLOEXEC)) {
  if (descriptor_ < 0) throw std::runtime_error("no memory for what a program writes");
  // Linux guards the position in a file on disk, but not in this one: of two threads that write, one could overwrite the other
  if (fcntl(descriptor_, F_SETFL, O_APPEND) != 0)
    throw std::runtime_error("what a program writes cannot be appended");
}

CaughtOutput::~CaughtOutput() {
  close(descriptor_);
}

std::string CaughtOutput::text() const {
  std::string text;
  char part[4096];
  ssize_t size = 0;
  while ((size = pread(descriptor_, part, sizeof part, static_cast<off_t>(text.size()))) > 0)
    text.append(part, static_cast<std::size_t>(size));
  return text;
}

}  // namespace palpate::testing
