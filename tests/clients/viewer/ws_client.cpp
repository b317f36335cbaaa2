// SPDX-License-Identifier: Apache-2.0
#include "ws_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace palpate::testing {

using Clock = std::chrono::steady_clock;

int connectTo(std::uint16_t port) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return fd;
  close(fd);
  throw std::runtime_error("no program listens on port " + std::to_string(port));
}

std::string httpExchange(std::uint16_t port, const std::string& request) {
  const int fd = connectTo(port);
  std::string answer;
  if (::send(fd, request.data(), request.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(request.size())) {
    char chunk[4096];
    pollfd wanted{fd, POLLIN, 0};
    for (ssize_t n = 0; poll(&wanted, 1, 5000) > 0 && (n = recv(fd, chunk, sizeof chunk, 0)) > 0;)
      answer.append(chunk, static_cast<std::size_t>(n));
  }
  close(fd);
  return answer;
}

std::string httpGet(std::uint16_t port, const std::string& path, const std::string& host) {
  return httpExchange(port, "GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n\r\n");
}

WsClient::WsClient(const WsRequest& request) : socket_(connectTo(request.port)) {
  const std::string host = request.host.empty() ? "127.0.0.1:" + std::to_string(request.port) : request.host;
  const std::string origin = request.origin.value_or("http://" + host);
  std::string text = "GET " + request.path + " HTTP/1.1\r\nHost: " + host +
                     "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                     "Sec-WebSocket-Key: cGFscGF0ZS1wYWdlLTAwMQ==\r\n";
  if (!origin.empty()) text += "Origin: " + origin + "\r\n";
  if (!request.subprotocol.empty()) text += "Sec-WebSocket-Protocol: " + request.subprotocol + "\r\n";
  sendRaw(text + request.headers + "\r\n");
  static constexpr std::string_view kEnd = "\r\n\r\n";
  const auto end = Clock::now() + std::chrono::seconds(10);
  auto at = buffer_.end();
  while ((at = std::search(buffer_.begin(), buffer_.end(), kEnd.begin(), kEnd.end())) == buffer_.end())
    if (!fill(buffer_.size() + 1, end)) return;
  const std::string head(buffer_.begin(), at);
  if (head.starts_with("HTTP/1.")) status_ = std::stoi(head.substr(9, 3));
  buffer_.erase(buffer_.begin(), at + kEnd.size());
}

WsClient::~WsClient() {
  close(socket_);
}

bool WsClient::sendRaw(const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t n = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) return false;
    sent += static_cast<std::size_t>(n);
  }
  return true;
}

bool WsClient::send(const std::string& text, std::uint8_t opcode, bool final) {
  constexpr std::uint8_t kMask[4] = {0x37, 0xfa, 0x21, 0x3d};
  std::string frame(1, static_cast<char>((final ? 0x80 : 0) | opcode));
  const std::size_t size = text.size();
  if (size < 126) {
    frame += static_cast<char>(0x80 | size);
  } else {
    const int bytes = size < 65536 ? 2 : 8;
    frame += static_cast<char>(0x80 | (bytes == 2 ? 126 : 127));
    for (int i = bytes - 1; i >= 0; --i) frame += static_cast<char>(size >> (8 * i) & 0xff);
  }
  frame.append(reinterpret_cast<const char*>(kMask), 4);
  for (std::size_t i = 0; i < size; ++i) frame += static_cast<char>(text[i] ^ kMask[i % 4]);
  return sendRaw(frame);
}

bool WsClient::fill(std::size_t size, Clock::time_point end) {
  while (buffer_.size() < size && !ended_) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd wanted{socket_, POLLIN, 0};
    if (poll(&wanted, 1, static_cast<int>(std::max<long>(left, 0))) <= 0) return false;
    std::uint8_t chunk[65536];
    const ssize_t n = recv(socket_, chunk, sizeof chunk, 0);
    if (n <= 0) ended_ = true;
    if (n > 0) buffer_.insert(buffer_.end(), chunk, chunk + n);
  }
  return buffer_.size() >= size;
}

std::vector<std::uint8_t> WsClient::take(std::size_t size) {
  const auto end = buffer_.begin() + static_cast<std::ptrdiff_t>(size);
  std::vector<std::uint8_t> taken(buffer_.begin(), end);
  buffer_.erase(buffer_.begin(), end);
  return taken;
}

WsMessage WsClient::receive(std::chrono::milliseconds timeout) {
  const auto end = Clock::now() + timeout;
  const auto missing = [&] {
    return WsMessage{ended_ ? WsMessage::Kind::kClosed : WsMessage::Kind::kTimeout, {}, 0};
  };
  while (true) {
    if (!fill(2, end)) return missing();
    std::size_t head = 2;
    std::uint64_t size = buffer_[1] & 0x7fU;
    if (size >= 126) {
      const std::size_t bytes = size == 126 ? 2 : 8;
      head += bytes;
      if (!fill(head, end)) return missing();
      size = 0;
      for (std::size_t i = 0; i < bytes; ++i) size = size << 8 | buffer_[2 + i];
    }
    if (!fill(head + size, end)) return missing();
    const std::uint8_t opcode = take(head)[0] & 0x0f;
    std::vector<std::uint8_t> bytes = take(size);
    if (opcode == 1) return {WsMessage::Kind::kText, std::move(bytes), 0};
    if (opcode == 2) return {WsMessage::Kind::kBinary, std::move(bytes), 0};
    if (opcode == 9) send(std::string(bytes.begin(), bytes.end()), 10);
    if (opcode != 8) continue;
    const unsigned code = bytes.size() >= 2 ? bytes[0] * 256U + bytes[1] : 0U;
    return {WsMessage::Kind::kClosed, {}, static_cast<std::uint16_t>(code)};
  }
}

}  // namespace palpate::testing
