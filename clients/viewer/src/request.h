// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <libwebsockets.h>

#include <string>
#include <string_view>

namespace palpate::viewer {

/// A request's header; empty when absent or longer than 16 kB. Headers of the same name come joined.
[[nodiscard]] std::string headerOf(lws* wsi, lws_token_indexes header);

/// Whether a body follows. None is read: what comes next would be taken for another request.
[[nodiscard]] bool hasBody(lws* wsi);

/// Numeric address of the sender; that of a proxy, where there is one.
[[nodiscard]] std::string peerOf(lws* wsi);

/// What every answer says: what the page may load and who may hold it.
[[nodiscard]] const lws_protocol_vhost_options* securityHeaders();

/// An answer that is no file.
struct Answer {
  unsigned status{200};
  std::string_view body{};
  const char* type{"text/plain; charset=utf-8"};
  std::string set_cookie{};
};

/// Writes an answer. @return whether it went out
[[nodiscard]] bool send(lws* wsi, const Answer& answer);

}  // namespace palpate::viewer
