// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "access.h"
#include "header_text.h"
#include "login.h"
#include "targets.h"

namespace palpate::fuzz {

namespace {

constexpr const char* kToken = "0123456789abcdef";
constexpr const char* kCode = "fedcba9876543210";
constexpr const char* kOrigin = "https://viewer.example.org";

std::string_view takeLine(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

bool isIn(std::string_view part, std::string_view whole) {
  return part.empty() ||
         (part.data() >= whole.data() && part.data() + part.size() <= whole.data() + whole.size());
}

}  // namespace

bool http(Bytes input) {
  std::string_view rest(reinterpret_cast<const char*>(input.data()), input.size());
  std::array<std::string_view, 6> lines;  // host, origin, authorization, cookies, peer, protocols
  for (std::string_view& line : lines) line = takeLine(rest);
  const auto& [host, origin, authorization, cookies, peer, protocols] = lines;
  const viewer::Credentials given{viewer::bearerIn(authorization),
                                  viewer::cookieIn(cookies, "palpate-viewer-8080"), peer};
  require(isIn(given.bearer, authorization) && isIn(given.cookie, cookies), "a part of a header is in it");
  (void)viewer::names(protocols, "palpate.viewer.v1");

  bool let_in = false;
  for (const char* listen : {"127.0.0.1", "0.0.0.0"})
    for (const bool tls : {false, true}) {
      const viewer::AccessRules rules({listen, 8080, kToken, {kOrigin}, tls});
      const char* const against = rules.refusal({host, origin, !given.bearer.empty()});
      require(against != nullptr || rules.hostAllowed(host), "who may come in has the right host");
      let_in = let_in || against == nullptr;
    }

  const viewer::LoginTime start{1'000'000'000, 1'700'000'000}, later{2'000'000'000, 1'700'000'001};
  viewer::Login login(kToken, kCode, start);
  if (login.refusal(given, later)) {
    require(given.bearer != kToken, "who bears the token is let in");
  } else {
    require(given.bearer == kToken, "nobody comes in without the token");  // no cookie was made
  }
  std::string cookie;
  if (!login.enter(given, later, cookie)) {
    require(given.bearer == kToken || given.bearer == kCode, "token or code were given");
    require(!login.needed(cookie, later), "who has entered has a cookie that holds");
  }
  return let_in;
}

}  // namespace palpate::fuzz
