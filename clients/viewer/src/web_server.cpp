// SPDX-License-Identifier: Apache-2.0
#include "web_server.h"

#include <spdlog/spdlog.h>

#include "door.h"
#include "header_text.h"
#include "page.h"
#include "palpate/client/error.h"
#include "palpate/client/stop_signal.h"
#include "palpate/rt/clock.h"
#include "rare_warning.h"
#include "request.h"

namespace palpate::viewer {
namespace {

constexpr std::int64_t kPeriodUs = 20'000;
constexpr std::size_t kMoreConnections = 64;  // beside the pages: files under way, handshakes, refusals
constexpr unsigned kMostHeaders = 16'384;     // bytes of a request: browsers bring the cookies of all ports
constexpr int kGoOn = 0;
constexpr int kHangUp = -1;

// A silent page is pinged after 10 s and closed after 20 s.
constexpr lws_retry_bo_t kIdle{nullptr, 0, 0, 10, 20, 0};

void logLine(int, const char* line) {
  std::string_view text(line);
  while (text.ends_with('\n')) text.remove_suffix(1);
  warnRarely(text);
}

// The callback's result after an answer that is no file.
int finish(lws* wsi, const Answer& answer) {
  return !send(wsi, answer) || lws_http_transaction_completed(wsi) != 0 ? kHangUp : kGoOn;
}

int refuseUpgrade(lws* wsi, const Refusal& refusal) {
  spdlog::debug("refused: {}", refusal.reason);
  return send(wsi, {.status = refusal.status, .body = refusal.reason}) ? 1 : kHangUp;
}

void useTls(const TlsFiles& files, lws_context_creation_info& info) {
  info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
  info.ssl_cert_filepath = files.certificate.c_str();
  info.ssl_private_key_filepath = files.key.c_str();
  info.ssl_options_set = SSL_OP_NO_SSLv3 | SSL_OP_NO_TLSv1 | SSL_OP_NO_TLSv1_1;
  info.alpn = "http/1.1";  // upgrades within HTTP/2 would not be judged
}

}  // namespace

void check(const WebOptions& options) {
  check(options.access);
  check(options.tls);
  (void)PageFiles(options.page);
}

struct WebServer::Connection {  // lws gives zeroed memory
  Page* page;
};

WebServer::WebServer(const WebOptions& options) : options_(options), files_(options.page) {
  options_.access.tls = options_.tls.given();
  lws_set_log_level(LLL_ERR, &logLine);
  listen();
}

void WebServer::listen() {
  static const lws_protocols kProtocols[] = {
      {"http", &WebServer::onEvent, 0, 0, 0, nullptr, 0},
      {kSubprotocol, &WebServer::onEvent, sizeof(Connection), kMaxMessage, 0, nullptr, 1U << 20},
      {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
  const std::string& address = options_.access.listen;
  lws_context_creation_info info{};
  info.port = options_.access.port;
  info.iface = address == "0.0.0.0" || address == "::" ? nullptr : address.c_str();
  info.protocols = kProtocols;
  info.gid = info.uid = -1;
  info.user = this;
  info.server_string = "palpate-viewer";
  info.options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS | LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
  if (address.find(':') == std::string::npos) info.options |= LWS_SERVER_OPTION_DISABLE_IPV6;
  info.fd_limit_per_thread = static_cast<unsigned>(options_.max_pages + kMoreConnections + 32);
  info.timeout_secs = 5;
  info.timeout_secs_ah_idle = 5;
  info.keepalive_timeout = 10;
  info.retry_and_idle_policy = &kIdle;
  info.max_http_header_data2 = kMostHeaders;
  info.headers = securityHeaders();
  if (options_.tls.given()) useTls(options_.tls, info);
  context_ = lws_create_context(&info);
  lws_vhost* vhost = context_ ? lws_create_vhost(context_, &info) : nullptr;
  if (vhost == nullptr) {
    if (context_) lws_context_destroy(context_);
    throw client::ClientError(
        "cannot listen on " + hostAndPort(address, options_.access.port) +
        ": is the port in use (--port 0 takes a free one), or the address not this machine's?");
  }
  options_.access.port = static_cast<std::uint16_t>(lws_get_vhost_listen_port(vhost));
  const std::string code = options_.access.token.empty() ? "" : randomCode();
  door_ = std::make_unique<Door>(options_.access, code);
  login_address_ = WebServer::address() + (code.empty() ? "" : "#code=" + code);
}

WebServer::~WebServer() {
  lws_context* context = nullptr;
  {
    const std::lock_guard lock(context_mutex_);
    context = std::exchange(context_, nullptr);
  }
  lws_context_destroy(context);
}

std::string WebServer::address() const {
  if (!options_.access.origins.empty()) return options_.access.origins.front() + "/";
  const std::string& listen = options_.access.listen;
  const bool all = listen == "0.0.0.0" || listen == "::";
  return (options_.access.tls ? "https://" : "http://") + hostAndPort(all ? "localhost" : listen, port()) +
         "/";
}

void WebServer::wake(void* server) noexcept {
  auto& self = *static_cast<WebServer*>(server);
  const std::lock_guard lock(self.context_mutex_);
  if (self.context_) lws_cancel_service(self.context_);
}

void WebServer::run(Viewer& viewer) {
  viewer_ = &viewer;
  timer_.server = this;
  onTimer(&timer_.timer);
  bool serves = true;
  while (serves && !client::stopRequested()) serves = lws_service(context_, 0) >= 0;
  const bool failed = !serves && !client::stopRequested();
  lws_sul_cancel(&timer_.timer);
  lws_context* context = nullptr;
  {
    const std::lock_guard lock(context_mutex_);
    context = std::exchange(context_, nullptr);
  }
  lws_context_destroy(context);  // closes the pages, which leave the viewer
  viewer_ = nullptr;
  if (failed) throw client::ClientError("libwebsockets gave up serving " + address());
}

void WebServer::onTimer(lws_sorted_usec_list_t* timer) {
  WebServer* self = reinterpret_cast<Timer*>(timer)->server;  // timer is its first member
  self->tend();
  lws_sul_schedule(self->context_, 0, timer, &WebServer::onTimer, kPeriodUs);
}

// Catches all: an error in data from DDS must not close a connection.
void WebServer::tend() noexcept {
  try {
    lookForNews();
  } catch (const std::exception& error) {
    warnRarely(error.what());
  }
}

void WebServer::lookForNews() {
  if (viewer_ == nullptr) return;
  const std::int64_t now_ns = rt::monotonicNow();
  viewer_->tend(now_ns);
  for (lws* wsi : pages_) {
    const auto* connection = static_cast<const Connection*>(lws_wsi_user(wsi));
    if (connection->page->wants(now_ns)) lws_callback_on_writable(wsi);
  }
}

int WebServer::onEvent(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t length) {
  lws_context* context = wsi ? lws_get_context(wsi) : nullptr;
  auto* self = context ? static_cast<WebServer*>(lws_context_user(context)) : nullptr;
  if (self == nullptr) return kGoOn;
  try {
    return self->handle(wsi, reason, user, in, length);
  } catch (const std::exception& error) {  // out of memory: closes this connection only
    spdlog::error("a connection is closed: {}", error.what());
    return kHangUp;
  }
}

int WebServer::handle(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t length) {
  switch (reason) {
    case LWS_CALLBACK_FILTER_NETWORK_CONNECTION:
      return connections_.size() < options_.max_pages + kMoreConnections ? kGoOn : 1;
    case LWS_CALLBACK_SERVER_NEW_CLIENT_INSTANTIATED:
      connections_.insert(wsi);
      return kGoOn;
    case LWS_CALLBACK_WSI_DESTROY:
      connections_.erase(wsi);
      return kGoOn;
    case LWS_CALLBACK_HTTP:
      return serve(wsi, std::string_view(static_cast<const char*>(in), length));
    case LWS_CALLBACK_HTTP_CONFIRM_UPGRADE:
      return judgeUpgrade(wsi, static_cast<const char*>(in));
    case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
      if (std::string_view(lws_get_protocol(wsi)->name) == "http") tend();  // comes once per protocol
      return kGoOn;
    case LWS_CALLBACK_ESTABLISHED:
    case LWS_CALLBACK_CLOSED:
    case LWS_CALLBACK_RECEIVE:
    case LWS_CALLBACK_SERVER_WRITEABLE:
      return handlePage(wsi, reason, static_cast<Connection*>(user), in, length);
    default:
      return lws_callback_http_dummy(wsi, reason, user, in, length);
  }
}

int WebServer::handlePage(lws* wsi, lws_callback_reasons reason, Connection* connection, void* in,
                          std::size_t length) {
  if (connection == nullptr || viewer_ == nullptr) return kHangUp;
  if (reason == LWS_CALLBACK_ESTABLISHED) {
    open(wsi, *connection);
    return kGoOn;
  }
  if (connection->page == nullptr) return kHangUp;
  if (reason == LWS_CALLBACK_CLOSED) {
    pages_.erase(wsi);
    spdlog::debug("page {} left, {} open", connection->page->id(), pages_.size());
    delete std::exchange(connection->page, nullptr);
    return kGoOn;
  }
  if (reason == LWS_CALLBACK_RECEIVE)
    return receive(wsi, *connection, std::string_view(static_cast<const char*>(in), length));
  return write(wsi, *connection);
}

int WebServer::serve(lws* wsi, std::string_view uri) {
  const bool get = lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) > 0;
  const bool post = lws_hdr_total_length(wsi, WSI_TOKEN_POST_URI) > 0;
  if (hasBody(wsi)) {
    (void)send(wsi, {.status = 413, .body = "no request has a body here"});
    return kHangUp;
  }
  if (!door_->hostAllowed(wsi)) return finish(wsi, {.status = 403, .body = "Host is not this viewer's"});
  if (uri == "/login" && (get || post)) return finish(wsi, post ? door_->login(wsi) : door_->loginState(wsi));
  if (!get) return finish(wsi, {.status = 405, .body = "only GET, and POST of /login"});
  return serveFile(wsi, uri);
}

int WebServer::serveFile(lws* wsi, std::string_view uri) const {
  const auto file = files_.find(uri);
  if (!file) return finish(wsi, {.status = 404, .body = "no such file"});
  const std::string headers = "cache-control: " + std::string(file->cache) + "\x0d\x0a";
  const int sent = lws_serve_http_file(wsi, file->path.c_str(), file->type, headers.data(),
                                       static_cast<int>(headers.size()));
  return sent < 0 || (sent > 0 && lws_http_transaction_completed(wsi) != 0) ? kHangUp : kGoOn;
}

int WebServer::judgeUpgrade(lws* wsi, std::string_view kind) {
  if (kind != "websocket") return kHangUp;
  if (const auto refusal = door_->refusal(wsi)) return refuseUpgrade(wsi, *refusal);
  if (headerOf(wsi, WSI_TOKEN_GET_URI) != "/ws") return refuseUpgrade(wsi, {404, "the WebSocket is at /ws"});
  if (!names(headerOf(wsi, WSI_TOKEN_PROTOCOL), kSubprotocol))
    return refuseUpgrade(wsi, {400, "the subprotocol is palpate.viewer.v1"});
  if (pages_.size() >= options_.max_pages) return refuseUpgrade(wsi, {503, "too many pages are open"});
  return kGoOn;
}

void WebServer::open(lws* wsi, Connection& connection) {
  connection.page =
      new Page(next_page_++, *viewer_, options_.rate_hz);  // lws owns it: deleted when it closes
  pages_.insert(wsi);
  spdlog::debug("page {} came, {} open", connection.page->id(), pages_.size());
  lws_callback_on_writable(wsi);
}

int WebServer::receive(lws* wsi, Connection& connection, std::string_view part) {
  const std::int64_t now_ns = rt::monotonicNow();
  const bool last = lws_is_final_fragment(wsi) != 0 && lws_remaining_packet_payload(wsi) == 0;
  const bool too_large = lws_remaining_packet_payload(wsi) > kMaxMessage;
  const Close close = too_large ? Close::kTooLarge
                                : connection.page->receive(part, lws_is_first_fragment(wsi) != 0, last,
                                                           lws_frame_is_binary(wsi) != 0, now_ns);
  if (close != Close::kNone) {
    warnRarely("page " + std::to_string(connection.page->id()) + " is shut out: close code " +
               std::to_string(static_cast<unsigned>(close)));
    lws_close_reason(wsi, static_cast<lws_close_status>(close), nullptr, 0);
    return kHangUp;
  }
  if (connection.page->wants(now_ns)) lws_callback_on_writable(wsi);
  return kGoOn;
}

int WebServer::write(lws* wsi, Connection& connection) {
  const std::int64_t now_ns = rt::monotonicNow();
  buffer_.assign(LWS_PRE, 0);
  const auto binary = connection.page->next(now_ns, buffer_);
  if (!binary) return kGoOn;
  const std::size_t size = buffer_.size() - LWS_PRE;
  const int sent =
      lws_write(wsi, buffer_.data() + LWS_PRE, size, *binary ? LWS_WRITE_BINARY : LWS_WRITE_TEXT);
  if (sent < static_cast<int>(size)) return kHangUp;
  if (connection.page->wants(now_ns)) lws_callback_on_writable(wsi);
  return kGoOn;
}

}  // namespace palpate::viewer
