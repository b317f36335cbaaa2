// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace palpate::testing {

/// A request for a WebSocket; by default that of a browser with the viewer's own page.
struct WsRequest {
  std::uint16_t port{0};
  std::string path{"/ws"};
  std::string host;                   ///< empty: 127.0.0.1:port
  std::optional<std::string> origin;  ///< nothing: http://host; "": none
  std::string subprotocol{"palpate.viewer.v1"};
  std::string headers;  ///< further ones, each with its line end
};

/// One message, or the end.
struct WsMessage {
  enum class Kind { kText, kBinary, kClosed, kTimeout } kind{Kind::kTimeout};
  std::vector<std::uint8_t> bytes;
  std::uint16_t close_code{0};  ///< 0: the connection ended without one
  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(bytes); }
};

/// A WebSocket client on a plain socket, which can also send what no browser sends. Threads: one.
class WsClient {
 public:
  /// Connects and shakes hands; status() has the outcome. @throw std::runtime_error  no program listens
  explicit WsClient(const WsRequest& request);
  ~WsClient();
  WsClient(const WsClient&) = delete;
  WsClient& operator=(const WsClient&) = delete;

  [[nodiscard]] int status() const noexcept { return status_; }  ///< HTTP; 101: it is open

  /// Sends one frame, masked. @return false when the connection is gone
  bool send(const std::string& text, std::uint8_t opcode = 1, bool final = true);
  bool say(const nlohmann::json& object) { return send(object.dump()); }
  /// Sends bytes unchanged.
  bool sendRaw(const std::string& bytes);

  /// The next message; answers WebSocket pings by itself.
  [[nodiscard]] WsMessage receive(std::chrono::milliseconds timeout);

 private:
  bool fill(std::size_t size, std::chrono::steady_clock::time_point end);
  [[nodiscard]] std::vector<std::uint8_t> take(std::size_t size);

  int socket_{-1};
  int status_{0};
  bool ended_{false};
  std::vector<std::uint8_t> buffer_;
};

/// A TCP connection to this machine. @throw std::runtime_error  no program listens
[[nodiscard]] int connectTo(std::uint16_t port);

/// What comes for a request that is sent unchanged, until the connection ends; empty when nothing does.
[[nodiscard]] std::string httpExchange(std::uint16_t port, const std::string& request);

/// The whole answer to GET, head and body; empty when the connection ends without one.
/// @param[in] path  sent unchanged
[[nodiscard]] std::string httpGet(std::uint16_t port, const std::string& path, const std::string& host);

}  // namespace palpate::testing
