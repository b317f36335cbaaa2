// SPDX-License-Identifier: Apache-2.0
#include "login.h"

#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

#include <array>
#include <charconv>

#include "palpate/client/error.h"

namespace palpate::viewer {
namespace {

constexpr Refusal kMissing{401, "the token is missing"};
constexpr Refusal kWrong{401, "the token is wrong, or the code was used or is too old"};
constexpr Refusal kTooOften{429, "too many wrong tokens: wait a minute"};

std::string hexOf(const unsigned char* bytes, std::size_t size) {
  static constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < size; ++i) (text += kDigits[bytes[i] >> 4U]) += kDigits[bytes[i] & 15U];
  return text;
}

std::string hmac(std::string_view key, std::string_view text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> code{};
  unsigned size = 0;
  const auto* bytes = reinterpret_cast<const unsigned char*>(text.data());
  if (HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()), bytes, text.size(), code.data(), &size) ==
      nullptr)
    throw client::ClientError("OpenSSL has no HMAC with SHA-256");
  return hexOf(code.data(), size);
}

}  // namespace

Login::Login(std::string token, std::string code, LoginTime now)
    : token_(std::move(token)), code_(std::move(code)), code_end_ns_(now.monotonic_ns + kCodeLifeNs) {}

bool Login::needed(std::string_view cookie, LoginTime now) const {
  if (token_.empty()) return false;
  std::int64_t end_s = 0;
  const auto [rest, error] = std::from_chars(cookie.data(), cookie.data() + cookie.size(), end_s);
  return error != std::errc() || end_s <= now.since_epoch_s || !sameSecret(cookie, cookieUntil(end_s));
}

std::optional<Refusal> Login::refusal(const Credentials& given, LoginTime now) {
  if (!needed(given.cookie, now)) return std::nullopt;
  if (given.bearer.empty()) return kMissing;
  if (!attempts_.take(given.peer, now.monotonic_ns)) return kTooOften;
  if (!sameSecret(given.bearer, token_)) return kWrong;
  attempts_.forgive(given.peer);
  return std::nullopt;
}

std::optional<Refusal> Login::enter(const Credentials& given, LoginTime now, std::string& cookie) {
  if (given.bearer.empty()) return kMissing;
  if (!attempts_.take(given.peer, now.monotonic_ns)) return kTooOften;
  if (!sameSecret(given.bearer, token_) && !useCode(given.bearer, now)) return kWrong;
  attempts_.forgive(given.peer);
  cookie = cookieUntil(now.since_epoch_s + kCookieLifeS);
  return std::nullopt;
}

bool Login::useCode(std::string_view given, LoginTime now) {
  if (!sameSecret(given, code_) || now.monotonic_ns > code_end_ns_) return false;
  code_.clear();
  return true;
}

std::string Login::cookieUntil(std::int64_t end_s) const {
  const std::string end = std::to_string(end_s);
  return end + "." + hmac(token_, "palpate-viewer cookie until " + end);
}

bool sameSecret(std::string_view given, std::string_view secret) noexcept {
  unsigned difference = given.size() == secret.size() ? 0U : 1U;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const char other = secret.empty() ? '\0' : secret[i % secret.size()];
    difference |= static_cast<unsigned char>(given[i] ^ other);
  }
  return difference == 0 && !secret.empty();
}

std::string randomCode() {
  std::array<unsigned char, 16> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
    throw client::ClientError("the system has no random numbers for a login code");
  return hexOf(bytes.data(), bytes.size());
}

}  // namespace palpate::viewer
