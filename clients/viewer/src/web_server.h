// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <libwebsockets.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "access.h"
#include "page_files.h"
#include "viewer.h"

namespace palpate::viewer {

/// Name of the WebSocket's subprotocol.
inline constexpr const char* kSubprotocol = "palpate.viewer.v1";

struct WebOptions {
  AccessOptions access;        ///< port 0: any free port
  std::filesystem::path page;  ///< folder
  std::size_t max_pages{16};   ///< in [1, 256]
  double rate_hz{60.0};        ///< most frames per second to a page
};

/// Serves the page's files and its WebSocket at /ws, on the thread that calls run(). Refuses requests against AccessRules
/// with 403, and pages beyond max_pages with 503.
class WebServer {
 public:
  /// @throw client::ClientError  the page is missing, or the address cannot be bound
  explicit WebServer(const WebOptions& options);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Serves until a stop signal comes. `viewer` must outlive the server.
  /// @throw client::ClientError  libwebsockets gave up earlier
  void run(Viewer& viewer);

  /// Makes run() look for news. Threads: any.
  static void wake(void* server) noexcept;

  /// "http://127.0.0.1:8080/"
  [[nodiscard]] std::string address() const;
  [[nodiscard]] std::uint16_t port() const noexcept { return rules_->options().port; }

 private:
  struct Connection;
  struct Timer {
    lws_sorted_usec_list_t timer;
    WebServer* server;
  };
  static int onEvent(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t length);
  static void onTimer(lws_sorted_usec_list_t* timer);

  int handle(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t length);
  int handlePage(lws* wsi, lws_callback_reasons reason, Connection* connection, void* in, std::size_t length);
  void listen();
  void tend() noexcept;
  void lookForNews();
  int serveFile(lws* wsi, std::string_view uri) const;
  int judgeUpgrade(lws* wsi, std::string_view kind) const;
  void open(lws* wsi, Connection& connection);
  int receive(lws* wsi, Connection& connection, std::string_view part);
  int write(lws* wsi, Connection& connection);

  WebOptions options_;
  PageFiles files_;
  std::unique_ptr<AccessRules> rules_;  // made once the port is known
  std::mutex context_mutex_;            // wake() against the destructor
  lws_context* context_{nullptr};
  Timer timer_{};
  Viewer* viewer_{nullptr};
  std::set<lws*> connections_;
  std::set<lws*> pages_;
  std::uint64_t next_page_{1};
  Bytes buffer_;
};

}  // namespace palpate::viewer
