// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "attempts.h"

namespace palpate::viewer {

/// Answer to a request that is not let in.
struct Refusal {
  unsigned status;  ///< HTTP
  const char* reason;
};

/// What a request shows of its sender. Empty: absent.
struct Credentials {
  std::string_view bearer;  ///< of "Authorization: Bearer ..."
  std::string_view cookie;  ///< value of the cookie that enter() made
  std::string_view peer;    ///< numeric address
};

struct LoginTime {
  std::int64_t monotonic_ns;
  std::int64_t since_epoch_s;
};

/// Who knows the token: programs bear it in a header of each request; a browser gives it, or the one-time code of the
/// printed address, once and gets a cookie. The cookie holds its end and an HMAC under the token, so it outlives this
/// program but not the token. docs/decisions/viewer_login.md. Threads: one.
class Login {
 public:
  static constexpr std::int64_t kCodeLifeNs = 600'000'000'000;
  static constexpr std::int64_t kCookieLifeS = 12 * 3600;

  /// @param[in] token  empty: nobody needs one
  /// @param[in] code   opens once, within kCodeLifeNs of `now`; empty: there is none
  Login(std::string token, std::string code, LoginTime now);

  [[nodiscard]] bool needed(std::string_view cookie, LoginTime now) const;

  /// @return nothing when a WebSocket may be opened, else the reason against it
  [[nodiscard]] std::optional<Refusal> refusal(const Credentials& given, LoginTime now);

  /// Takes token or code as the bearer. @param[out] cookie  its value
  [[nodiscard]] std::optional<Refusal> enter(const Credentials& given, LoginTime now, std::string& cookie);

 private:
  [[nodiscard]] std::string cookieUntil(std::int64_t end_s) const;
  [[nodiscard]] bool useCode(std::string_view given, LoginTime now);

  std::string token_;
  std::string code_;
  std::int64_t code_end_ns_;
  Attempts attempts_;
};

/// Whether the two are equal; nothing equals an empty secret. The time depends only on the length of `given`.
[[nodiscard]] bool sameSecret(std::string_view given, std::string_view secret) noexcept;

/// 128 random bits in hexadecimal. @throw client::ClientError  the system has none
[[nodiscard]] std::string randomCode();

}  // namespace palpate::viewer
