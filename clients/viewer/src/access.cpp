// SPDX-License-Identifier: Apache-2.0
#include "access.h"

#include <arpa/inet.h>

#include <algorithm>
#include <cctype>

#include "palpate/client/error.h"

namespace palpate::viewer {
namespace {

constexpr std::size_t kLeastToken = 16;
constexpr std::size_t kMostToken = 128;

bool isNumeric(const std::string& address) noexcept {
  in6_addr bits{};
  return inet_pton(AF_INET, address.c_str(), &bits) == 1 || inet_pton(AF_INET6, address.c_str(), &bits) == 1;
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

// The name in "name:port" or "[name]:port"; `rest` gets the port.
std::string nameOf(std::string_view host, std::string_view& rest) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return {};
    rest = host.substr(end + 1);
    return lower(host.substr(1, end - 1));
  }
  const std::size_t colon = host.find(':');
  rest = colon == std::string_view::npos ? std::string_view() : host.substr(colon);
  return lower(host.substr(0, colon));
}

// The Host header that belongs to "https://name:port".
std::string_view hostOfOrigin(std::string_view origin) {
  const std::size_t at = origin.find("://");
  return at == std::string_view::npos ? std::string_view() : origin.substr(at + 3);
}

void checkToken(const std::string& token) {
  const bool letters = std::all_of(token.begin(), token.end(), [](unsigned char c) {
    return (c < 128 && std::isalnum(c) != 0) || c == '-' || c == '_';
  });
  if (token.size() < kLeastToken || token.size() > kMostToken || !letters)
    throw client::ClientError("the token has " + std::to_string(token.size()) +
                              " characters, expected 16 to 128 letters, digits, - and _");
}

void checkOrigin(const std::string& origin) {
  const std::string_view host = hostOfOrigin(origin);
  const bool scheme = origin.starts_with("http://") || origin.starts_with("https://");
  if (!scheme || host.empty() || host.find_first_of("/?#@ ") != std::string_view::npos)
    throw client::ClientError("--origin is '" + origin + "', expected http(s)://name or http(s)://name:port");
}

}  // namespace

void check(const AccessOptions& options) {
  if (!isNumeric(options.listen))
    throw client::ClientError("--listen is '" + options.listen +
                              "', expected a numeric address, e.g. 127.0.0.1, ::1 or 0.0.0.0");
  if (!options.token.empty()) checkToken(options.token);
  if (options.token.empty() && !isLoopback(options.listen))
    throw client::ClientError(
        "--listen " + options.listen +
        " lets other machines in: it needs --token-file (openssl rand -hex 16 makes a token)");
  for (const std::string& origin : options.origins) checkOrigin(origin);
}

bool isLoopback(std::string_view address) noexcept {
  const std::string text(address);
  in_addr v4{};
  if (inet_pton(AF_INET, text.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24) == 127;
  in6_addr v6{};
  return inet_pton(AF_INET6, text.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6) != 0;
}

bool AccessRules::hostAllowed(std::string_view host) const {
  const std::string whole = lower(host);
  for (const std::string& origin : options_.origins)
    if (whole == lower(hostOfOrigin(origin))) return true;
  std::string_view rest;
  const std::string name = nameOf(host, rest);
  const std::string port = std::string(":").append(std::to_string(options_.port));
  if (rest != port && !(rest.empty() && options_.port == (options_.tls ? 443 : 80))) return false;
  if (name == "localhost") return true;
  return isLoopback(options_.listen) ? isLoopback(name) : isNumeric(name);
}

bool AccessRules::originAllowed(std::string_view origin, std::string_view host) const {
  if (lower(origin) == (options_.tls ? "https://" : "http://") + lower(host)) return true;
  return std::any_of(options_.origins.begin(), options_.origins.end(),
                     [&](const std::string& other) { return lower(other) == lower(origin); });
}

const char* AccessRules::refusal(const UpgradeRequest& request) const {
  if (!hostAllowed(request.host)) return "Host is not this viewer's";
  if (request.origin.empty())
    return request.bears_token && !options_.token.empty() ? nullptr : "Origin is missing";
  return originAllowed(request.origin, request.host) ? nullptr : "Origin is not this viewer's";
}

std::string hostAndPort(const std::string& address, std::uint16_t port) {
  const bool v6 = address.find(':') != std::string::npos;
  std::string text = v6 ? std::string("[").append(address).append("]") : address;
  return text.append(":").append(std::to_string(port));
}

}  // namespace palpate::viewer
