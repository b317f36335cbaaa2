// SPDX-License-Identifier: Apache-2.0
#include "door.h"

#include <chrono>

#include "header_text.h"
#include "palpate/rt/clock.h"
#include "rare_warning.h"

namespace palpate::viewer {
namespace {

LoginTime timeNow() {
  const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
  return {rt::monotonicNow(), std::chrono::duration_cast<std::chrono::seconds>(since_epoch).count()};
}

// The headers that are judged, while they are judged.
struct Sender {
  Sender(lws* wsi, std::string_view cookie_name)
      : host(headerOf(wsi, WSI_TOKEN_HOST)),
        origin(headerOf(wsi, WSI_TOKEN_ORIGIN)),
        authorization(headerOf(wsi, WSI_TOKEN_HTTP_AUTHORIZATION)),
        cookies(headerOf(wsi, WSI_TOKEN_HTTP_COOKIE)),
        peer(peerOf(wsi)),
        credentials{bearerIn(authorization), cookieIn(cookies, cookie_name), peer} {}
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  [[nodiscard]] UpgradeRequest request() const { return {host, origin, !credentials.bearer.empty()}; }

  std::string host, origin, authorization, cookies, peer;
  Credentials credentials;
};

// A page that comes without a token asks for it: no news.
void report(const Sender& sender, const Refusal& refusal) {
  if (!sender.credentials.bearer.empty()) warnRarely(sender.peer + ": " + refusal.reason);
}

constexpr const char* kJson = "application/json";
constexpr std::string_view kNeeded = R"({"needed":true})";
constexpr std::string_view kNotNeeded = R"({"needed":false})";

}  // namespace

Door::Door(const AccessOptions& options, std::string code)
    : rules_(options),
      login_(options.token, std::move(code), timeNow()),
      cookie_name_("palpate-viewer-" + std::to_string(options.port)) {}

bool Door::hostAllowed(lws* wsi) const {
  return rules_.hostAllowed(headerOf(wsi, WSI_TOKEN_HOST));
}

std::optional<Refusal> Door::refusal(lws* wsi) {
  const Sender sender(wsi, cookie_name_);
  if (const char* reason = rules_.refusal(sender.request())) return Refusal{403, reason};
  const auto refusal = login_.refusal(sender.credentials, timeNow());
  if (refusal) report(sender, *refusal);
  return refusal;
}

Answer Door::loginState(lws* wsi) const {
  const Sender sender(wsi, cookie_name_);
  const bool needed = login_.needed(sender.credentials.cookie, timeNow());
  return {.body = needed ? kNeeded : kNotNeeded, .type = kJson};
}

Answer Door::login(lws* wsi) {
  const Sender sender(wsi, cookie_name_);
  if (const char* reason = rules_.refusal(sender.request())) return {.status = 403, .body = reason};
  std::string cookie;
  if (const auto refusal = login_.enter(sender.credentials, timeNow(), cookie)) {
    report(sender, *refusal);
    return {.status = refusal->status, .body = refusal->reason};
  }
  const bool secure = rules_.options().tls || sender.origin.starts_with("https://");
  return {.body = kNotNeeded,
          .type = kJson,
          .set_cookie = cookie_name_ + "=" + cookie + "; Path=/; HttpOnly; SameSite=Strict" +
                        (secure ? "; Secure" : "")};
}

}  // namespace palpate::viewer
