// SPDX-License-Identifier: Apache-2.0
#include "request.h"

#include <array>

namespace palpate::viewer {

std::string headerOf(lws* wsi, lws_token_indexes header) {
  constexpr int kMost = 1024;
  const int length = lws_hdr_total_length(wsi, header);
  if (length <= 0 || length > kMost) return {};
  std::string text(static_cast<std::size_t>(length) + 1, '\0');
  const int copied = lws_hdr_copy(wsi, text.data(), length + 1, header);
  text.resize(copied > 0 ? static_cast<std::size_t>(copied) : 0);
  return text;
}

std::string tokenOf(lws* wsi) {
  std::array<char, 256> buffer{};
  const char* token = lws_get_urlarg_by_name(wsi, "token=", buffer.data(), static_cast<int>(buffer.size()));
  return token ? token : "";
}

bool names(std::string_view list, std::string_view name) {
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    std::string_view item = list.substr(0, comma);
    while (item.starts_with(' ')) item.remove_prefix(1);
    while (item.ends_with(' ')) item.remove_suffix(1);
    if (item == name) return true;
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return false;
}

std::string headersOf(const PageFile& file, const std::string& host) {
  // In some browsers 'self' does not include the WebSocket, so it is named.
  return "Content-Security-Policy: default-src 'self'; connect-src 'self' ws://" + host + " wss://" + host +
         "; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; object-src 'none'; base-uri "
         "'none'; "
         "frame-ancestors 'none'; form-action 'none'\x0d\x0a"
         "X-Content-Type-Options: nosniff\x0d\x0a"
         "Referrer-Policy: no-referrer\x0d\x0a"
         "Cache-Control: " +
         std::string(file.cache) + "\x0d\x0a";
}

int refuse(lws* wsi, unsigned code, const char* reason) {
  return lws_return_http_status(wsi, code, reason) != 0 || lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
}

int refuseUpgrade(lws* wsi, unsigned code, const char* reason) {
  return lws_return_http_status(wsi, code, reason) != 0 ? -1 : 1;
}

}  // namespace palpate::viewer
