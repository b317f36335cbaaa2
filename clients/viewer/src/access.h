// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::viewer {

/// Who may come in, as the operator said it.
struct AccessOptions {
  std::string listen{"127.0.0.1"};   ///< numeric address
  std::uint16_t port{8080};          ///< that is really listened on
  std::string token;                 ///< empty: none; else 16 to 128 letters, digits, - and _
  std::vector<std::string> origins;  ///< further ones, e.g. "https://viewer.example.org"
};

/// What a browser, or something else, asks with. Empty: absent.
struct UpgradeRequest {
  std::string_view host;
  std::string_view origin;
  std::string_view token;
};

/// @throw client::ClientError  no numeric address, an address beyond this machine without a token, a token or an
///        origin that cannot be one
void check(const AccessOptions& options);

/// Whether only this machine reaches a numeric address.
[[nodiscard]] bool isLoopback(std::string_view address) noexcept;

/// Equal, in a time that depends on the length of `given` only.
[[nodiscard]] bool sameSecret(std::string_view given, std::string_view secret) noexcept;

/// Judges requests. Browsers send Host and Origin truly: a page of another site, or of a name that was bent to
/// point here (DNS rebinding), is told apart by them. Threads: any, const.
class AccessRules {
 public:
  explicit AccessRules(AccessOptions options) : options_(std::move(options)) {}

  /// A Host is ours when it is localhost or a numeric address (of this machine only, when only that is listened
  /// on) with our port, or that of a further origin.
  [[nodiscard]] bool hostAllowed(std::string_view host) const;

  /// @return nullptr when a WebSocket may be opened, else why not
  [[nodiscard]] const char* refusal(const UpgradeRequest& request) const;

  [[nodiscard]] const AccessOptions& options() const noexcept { return options_; }

 private:
  [[nodiscard]] bool originAllowed(std::string_view origin, std::string_view host) const;

  AccessOptions options_;
};

/// "127.0.0.1:8080", "[::1]:8080".
[[nodiscard]] std::string hostAndPort(const std::string& address, std::uint16_t port);

}  // namespace palpate::viewer
