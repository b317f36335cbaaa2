// SPDX-License-Identifier: Apache-2.0
#include "server_process.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

#include "palpate/test/paths.h"

namespace palpate::server::testing {
namespace {

[[noreturn]] void become(const std::vector<std::string>& arguments, const std::string& log_path, int log_fd) {
  const int log = log_fd >= 0 ? log_fd : open(log_path.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
  dup2(log, STDERR_FILENO);
  std::vector<char*> argv{const_cast<char*>("palpate-server")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv((palpate::testing::binDir() + "/palpate-server").c_str(), argv.data());
  _exit(127);
}

}  // namespace

ServerProcess::ServerProcess(const std::vector<std::string>& arguments, int log_fd)
    : log_path_("/tmp/palpate-server-test-" + std::to_string(getpid()) + ".log") {
  pid_ = fork();
  if (pid_ == 0) become(arguments, log_path_, log_fd);
}

ServerProcess::~ServerProcess() {
  if (running()) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  std::remove(log_path_.c_str());
}

void ServerProcess::signal(int number) const {
  if (pid_ > 0) kill(pid_, number);
}

bool ServerProcess::running() {
  int status = 0;
  if (pid_ > 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    pid_ = -1;
  }
  return pid_ > 0;
}

int ServerProcess::waitForExit(std::chrono::seconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (running() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return exit_code_;
}

std::string ServerProcess::log() const {
  std::ostringstream text;
  text << std::ifstream(log_path_).rdbuf();
  return text.str();
}

}  // namespace palpate::server::testing
