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
#include "tls.h"
#include "viewer.h"

namespace palpate::viewer {

class Door;

/// Name of the WebSocket's subprotocol.
inline constexpr const char* kSubprotocol = "palpate.viewer.v1";

struct WebOptions {
  AccessOptions access;  ///< port 0: any free port
  TlsFiles tls;
  std::filesystem::path page;  ///< folder
  std::size_t max_pages{16};   ///< in [1, 256]
  double rate_hz{60.0};        ///< most frames per second to a page
};

/// Whether a server can begin with them, but for the address, which only binding tries.
/// @throw client::ClientError  the page is missing, who may connect is not said right, or TLS' files cannot be used
void check(const WebOptions& options);

/// Serves the page's files, /login and its WebSocket at /ws, on the thread that calls run(). Door judges requests; pages
/// beyond max_pages get 503.
class WebServer {
 public:
  /// @param[in] options  that check() takes
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

  /// "http://127.0.0.1:8080/"; the first further origin, where there is one.
  [[nodiscard]] std::string address() const;
  /// The address that lets a browser in once, within 10 minutes; without a token the same as address().
  [[nodiscard]] const std::string& loginAddress() const noexcept { return login_address_; }
  [[nodiscard]] std::uint16_t port() const noexcept { return options_.access.port; }

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
  int serve(lws* wsi, std::string_view uri);
  int serveFile(lws* wsi, std::string_view uri) const;
  int judgeUpgrade(lws* wsi, std::string_view kind);
  void open(lws* wsi, Connection& connection);
  int receive(lws* wsi, Connection& connection, std::string_view part);
  int write(lws* wsi, Connection& connection);

  WebOptions options_;
  PageFiles files_;
  std::unique_ptr<Door> door_;  // made once the port is known
  std::string login_address_;
  std::mutex context_mutex_;  // wake() against the destructor
  lws_context* context_{nullptr};
  Timer timer_{};
  Viewer* viewer_{nullptr};
  std::set<lws*> connections_;
  std::set<lws*> pages_;
  std::uint64_t next_page_{1};
  Bytes buffer_;
};

}  // namespace palpate::viewer
