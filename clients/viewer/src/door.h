// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <libwebsockets.h>

#include <optional>
#include <string>

#include "access.h"
#include "login.h"
#include "request.h"

namespace palpate::viewer {

/// Judges requests by where they come from (AccessRules) and by who sends them (Login), and answers /login. Threads: one.
class Door {
 public:
  /// @param[in] code  opens once instead of the token; empty: there is none
  Door(const AccessOptions& options, std::string code);

  [[nodiscard]] bool hostAllowed(lws* wsi) const;

  /// @return nothing when the request may open a WebSocket, else the reason against it
  [[nodiscard]] std::optional<Refusal> refusal(lws* wsi);

  /// GET /login: whether the sender must give the token first.
  [[nodiscard]] Answer loginState(lws* wsi) const;

  /// POST /login: takes the token or the code, and gives a cookie.
  [[nodiscard]] Answer login(lws* wsi);

 private:
  AccessRules rules_;
  Login login_;
  std::string cookie_name_;
};

}  // namespace palpate::viewer
