// SPDX-License-Identifier: Apache-2.0
#include "palpate/testing/viewer_process.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace palpate::testing {
namespace {

// One line from a pipe; each byte within 20 s.
std::string readLine(int fd) {
  std::string line;
  pollfd wanted{fd, POLLIN, 0};
  char c = 0;
  while (poll(&wanted, 1, 20'000) > 0 && read(fd, &c, 1) == 1 && c != '\n') line += c;
  return line;
}

}  // namespace

ViewerProcess::ViewerProcess(const std::string& domain, const std::vector<std::string>& more) {
  page_.write("index.html", "<!doctype html><title>organ</title>");
  std::vector<std::string> arguments{"--domain", domain, "--port", "0", "--page", page_.path().string(),
                                     "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  process_.emplace("palpate-viewer", arguments, ChildProcess::Streams{.out = ends[1]});
  close(ends[1]);
  announcement_ = readLine(ends[0]);
  close(ends[0]);
  const auto said = nlohmann::json::parse(announcement_, nullptr, false);
  if (said.is_object()) port_ = said.value("port", std::uint16_t{0});
}

int ViewerProcess::end(int signal) {
  process_->signal(signal);
  return process_->waitForExit(std::chrono::seconds(20));
}

}  // namespace palpate::testing
