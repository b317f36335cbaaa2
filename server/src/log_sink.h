// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <poll.h>
#include <spdlog/sinks/base_sink.h>
#include <unistd.h>

#include <mutex>

namespace palpate::server {

/// Log lines to standard error that never wait: a line that its reader has no room for is lost.
/// The program that started the server may have stopped reading our pipe; the server still has to end.
class LogSink : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    pollfd room{STDERR_FILENO, POLLOUT, 0};
    if (poll(&room, 1, 0) != 1 || (room.revents & POLLOUT) == 0) return;
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    // A pipe with room takes PIPE_BUF bytes without waiting; a longer line may not fit.
    const std::size_t length = line.size() < kLongest ? line.size() : kLongest;
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), length);
  }
  void flush_() override {}

 private:
  static constexpr std::size_t kLongest = 4096;  // PIPE_BUF
};

}  // namespace palpate::server
