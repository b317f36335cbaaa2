// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::viewer {

/// Who may connect, as the operator set it.
struct AccessOptions {
  std::string listen{"127.0.0.1"};   ///< numeric address
  std::uint16_t port{8080};          ///< the port in use
  std::string token;                 ///< 16 to 128 letters, digits, - and _; empty: none is needed
  std::vector<std::string> origins;  ///< further ones, e.g. "https://viewer.example.org"
  bool tls{false};                   ///< our own pages come by https
};

/// The headers of a request that are judged. Empty: absent.
struct UpgradeRequest {
  std::string_view host;
  std::string_view origin;
  bool bears_token{false};  ///< has an Authorization header; Login judges it
};

/// @throw client::ClientError  the address is not numeric, or reaches beyond this machine without a token; the token or
///        an origin is malformed
void check(const AccessOptions& options);

/// Whether only this machine can reach a numeric address.
[[nodiscard]] bool isLoopback(std::string_view address) noexcept;

/// Judges requests. Browsers fill in Host and Origin truthfully. These tell a page of another site, and a name that was
/// made to point here (DNS rebinding), from our page. Threads: any, const.
class AccessRules {
 public:
  explicit AccessRules(AccessOptions options) : options_(std::move(options)) {}

  /// Allowed with our port: localhost and numeric addresses, only loopback ones where we listen on loopback. Also
  /// allowed: the host of a further origin.
  [[nodiscard]] bool hostAllowed(std::string_view host) const;

  /// Judges where a request comes from, before Login judges who sends it. Without an Origin only a program that bears a
  /// token goes on.
  /// @return nullptr when it may go on, else the reason against it
  [[nodiscard]] const char* refusal(const UpgradeRequest& request) const;

  [[nodiscard]] const AccessOptions& options() const noexcept { return options_; }

 private:
  [[nodiscard]] bool originAllowed(std::string_view origin, std::string_view host) const;

  AccessOptions options_;
};

/// "127.0.0.1:8080", "[::1]:8080".
[[nodiscard]] std::string hostAndPort(const std::string& address, std::uint16_t port);

}  // namespace palpate::viewer
