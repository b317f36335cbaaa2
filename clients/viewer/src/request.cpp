// SPDX-License-Identifier: Apache-2.0
#include "request.h"

#include <array>

namespace palpate::viewer {
namespace {

constexpr int kMostHeader = 16'384;  // of all cookies that other programs on this machine gave a browser

// Collects the head of an answer; lws's functions return nonzero where there is no room.
class Head {
 public:
  Head(lws* wsi, unsigned status) : wsi_(wsi) {
    fits_ = lws_add_http_header_status(wsi_, status, &at_, end()) == 0;
  }
  void add(const char* name, std::string_view value) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(value.data());
    fits_ = fits_ && lws_add_http_header_by_name(wsi_, reinterpret_cast<const unsigned char*>(name), bytes,
                                                 static_cast<int>(value.size()), &at_, end()) == 0;
  }
  // Ends the head, appends the body and writes both.
  [[nodiscard]] bool write(std::string_view body) {
    fits_ = fits_ && lws_add_http_header_content_length(wsi_, body.size(), &at_, end()) == 0 &&
            lws_finalize_http_header(wsi_, &at_, end()) == 0 &&
            static_cast<std::size_t>(end() - at_) >= body.size();
    if (!fits_) return false;
    at_ = std::copy(body.begin(), body.end(), at_);
    const auto size = static_cast<std::size_t>(at_ - begin());
    return lws_write(wsi_, begin(), size, LWS_WRITE_HTTP_HEADERS) == static_cast<int>(size);
  }

 private:
  unsigned char* begin() { return buffer_.data() + LWS_PRE; }
  unsigned char* end() { return buffer_.data() + buffer_.size(); }

  lws* wsi_;
  std::array<unsigned char, LWS_PRE + 2048> buffer_{};
  unsigned char* at_{begin()};
  bool fits_{false};
};

}  // namespace

std::string headerOf(lws* wsi, lws_token_indexes header) {
  const int length = lws_hdr_total_length(wsi, header);
  if (length <= 0 || length > kMostHeader) return {};
  std::string text(static_cast<std::size_t>(length) + 1, '\0');
  const int copied = lws_hdr_copy(wsi, text.data(), length + 1, header);
  text.resize(copied > 0 ? static_cast<std::size_t>(copied) : 0);
  return text;
}

bool hasBody(lws* wsi) {
  const std::string length = headerOf(wsi, WSI_TOKEN_HTTP_CONTENT_LENGTH);
  return (!length.empty() && length != "0") ||
         lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_TRANSFER_ENCODING) > 0;
}

std::string peerOf(lws* wsi) {
  std::array<char, 64> name{};
  return lws_get_peer_simple(wsi, name.data(), name.size()) ? name.data() : "";
}

const lws_protocol_vhost_options* securityHeaders() {
  static const lws_protocol_vhost_options kResource{nullptr, nullptr,
                                                    "cross-origin-resource-policy:", "same-origin"};
  static const lws_protocol_vhost_options kOpener{&kResource, nullptr,
                                                  "cross-origin-opener-policy:", "same-origin"};
  static const lws_protocol_vhost_options kReferrer{&kOpener, nullptr, "referrer-policy:", "no-referrer"};
  static const lws_protocol_vhost_options kSniff{&kReferrer, nullptr, "x-content-type-options:", "nosniff"};
  // 'self' includes the WebSocket at the same host and port. The form is sent by a script.
  static const lws_protocol_vhost_options kPolicy{
      &kSniff, nullptr, "content-security-policy:",
      "default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self'; connect-src 'self'; "
      "img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"};
  return &kPolicy;
}

bool send(lws* wsi, const Answer& answer) {
  Head head(wsi, answer.status);
  head.add("content-type:", answer.type);
  head.add("cache-control:", "no-store");
  if (answer.status == 401) head.add("www-authenticate:", "Bearer");
  if (!answer.set_cookie.empty()) head.add("set-cookie:", answer.set_cookie);
  return head.write(answer.body);
}

}  // namespace palpate::viewer
