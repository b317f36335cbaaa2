// SPDX-License-Identifier: Apache-2.0
#include "viewer_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "palpate/test/paths.h"

namespace palpate::testing {
namespace {

// One line from a pipe, within 20 s.
std::string readLine(int fd) {
  std::string line;
  pollfd wanted{fd, POLLIN, 0};
  char c = 0;
  while (poll(&wanted, 1, 20'000) > 0 && read(fd, &c, 1) == 1 && c != '\n') line += c;
  return line;
}

}  // namespace

ViewerProcess::ViewerProcess(const std::string& domain, const std::vector<std::string>& more)
    : page_(std::filesystem::temp_directory_path() / ("palpate-viewer-page-" + std::to_string(getpid()))) {
  std::filesystem::create_directories(page_);
  std::ofstream(page_ / "index.html") << "<!doctype html><title>organ</title>";
  std::vector<std::string> words{"palpate-viewer", "--domain",     domain,  "--port", "0",
                                 "--page",         page_.string(), "--json"};
  words.insert(words.end(), more.begin(), more.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  pid_ = fork();
  if (pid_ == 0) {
    dup2(ends[1], STDOUT_FILENO);
    execv((palpate::testing::binDir() + "/palpate-viewer").c_str(), argv.data());
    _exit(127);
  }
  close(ends[1]);
  announcement_ = readLine(ends[0]);
  close(ends[0]);
  const auto said = nlohmann::json::parse(announcement_, nullptr, false);
  if (said.is_object()) port_ = said.value("port", std::uint16_t{0});
}

ViewerProcess::~ViewerProcess() {
  if (running()) end(SIGKILL);
  std::filesystem::remove_all(page_);
}

bool ViewerProcess::running() {
  int status = 0;
  if (pid_ > 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    pid_ = -1;
  }
  return pid_ > 0;
}

int ViewerProcess::end(int signal) {
  if (running()) kill(pid_, signal);
  for (int i = 0; i < 4000 && running(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return exit_code_;
}

}  // namespace palpate::testing
