// SPDX-License-Identifier: Apache-2.0
// Who knows the token, and how often it may be guessed.
#include "login.h"

#include <gtest/gtest.h>

#include "header_text.h"

namespace palpate::viewer {
namespace {

constexpr const char* kGoodToken = "0123456789abcdef-_X";
constexpr const char* kCode = "00112233445566778899aabbccddeeff";
constexpr const char* kPeer = "192.168.1.9";
constexpr LoginTime kStart{1'000'000'000, 1'800'000'000};

LoginTime after(std::int64_t seconds) {
  return {kStart.monotonic_ns + 1'000'000'000 * seconds, kStart.since_epoch_s + seconds};
}

unsigned statusOf(const std::optional<Refusal>& refusal) {
  return refusal ? refusal->status : 200U;
}

std::string cookieFor(Login& login, std::string_view bearer, LoginTime now = kStart) {
  std::string cookie;
  EXPECT_EQ(statusOf(login.enter({bearer, "", kPeer}, now, cookie)), 200U);
  return cookie;
}

TEST(Login, NothingGoesWithoutTheTokenWhereThereIsOne) {
  Login login(kGoodToken, kCode, kStart);
  EXPECT_EQ(statusOf(login.refusal({kGoodToken, "", kPeer}, kStart)), 200U);
  for (const char* bearer :
       {"", "0", "0123456789abcdef-_Y", "0123456789abcdef-_XX", "0123456789abcdef", kCode})
    EXPECT_EQ(statusOf(login.refusal({bearer, "", kPeer}, kStart)), 401U) << bearer;
  Login open("", "", kStart);
  EXPECT_EQ(statusOf(open.refusal({"", "", kPeer}, kStart)), 200U);
  EXPECT_FALSE(open.needed("", kStart));
}

TEST(Login, ACookieLastsTwelveHoursAndOutlivesTheProgramButNotTheToken) {
  Login login(kGoodToken, "", kStart);
  const std::string cookie = cookieFor(login, kGoodToken);
  EXPECT_EQ(statusOf(login.refusal({"", cookie, kPeer}, after(12 * 3600 - 1))), 200U);
  EXPECT_EQ(statusOf(login.refusal({"", cookie, kPeer}, after(12 * 3600))), 401U);
  EXPECT_FALSE(Login(kGoodToken, kCode, after(10)).needed(cookie, after(10)));
  EXPECT_TRUE(Login("another-token-0123456789", "", after(10)).needed(cookie, after(10)));
}

TEST(Login, ACookieCannotBeMadeOrProlongedAndDoesNotHoldTheToken) {
  Login login(kGoodToken, "", kStart);
  const std::string cookie = cookieFor(login, kGoodToken);
  EXPECT_EQ(cookie.find(kGoodToken), std::string::npos);
  const std::string seal = cookie.substr(cookie.find('.'));
  for (const std::string& other :
       {"1900000000" + seal, seal, std::string("1900000000"), cookie + "0", " " + cookie,
        std::string(kGoodToken), std::string("99999999999999999999") + seal})
    EXPECT_TRUE(login.needed(other, kStart)) << other;
}

TEST(Login, TheCodeOpensOnceAndForTenMinutes) {
  Login login(kGoodToken, kCode, kStart);
  EXPECT_FALSE(login.needed(cookieFor(login, kCode, after(599)), after(600)));
  std::string cookie;
  EXPECT_EQ(statusOf(login.enter({kCode, "", kPeer}, after(599), cookie)), 401U) << "used";
  Login late(kGoodToken, kCode, kStart);
  EXPECT_EQ(statusOf(late.enter({kCode, "", kPeer}, after(601), cookie)), 401U) << "too old";
  EXPECT_TRUE(cookie.empty());
  EXPECT_FALSE(late.needed(cookieFor(late, kGoodToken, after(601)), after(601))) << "the token still opens";
}

TEST(Login, WrongTokensOfOneAddressAreCountedAndOthersComeIn) {
  Login login(kGoodToken, "", kStart);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(statusOf(login.refusal({"wrong", "", kPeer}, kStart)), 401U) << i;
  EXPECT_EQ(statusOf(login.refusal({"wrong", "", kPeer}, kStart)), 429U);
  EXPECT_EQ(statusOf(login.refusal({kGoodToken, "", kPeer}, kStart)), 429U) << "a guess must not show";
  EXPECT_EQ(statusOf(login.refusal({kGoodToken, "", "192.168.1.10"}, kStart)), 200U);
  EXPECT_EQ(statusOf(login.refusal({kGoodToken, "", kPeer}, after(7))), 200U) << "10 per minute";
}

TEST(Login, APageThatReconnectsIsNeverCounted) {
  Login login(kGoodToken, "", kStart);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(statusOf(login.refusal({"", "1.stale", kPeer}, kStart)), 401U);
    EXPECT_EQ(statusOf(login.refusal({kGoodToken, "", kPeer}, kStart)), 200U);
  }
}

TEST(Attempts, ManyAddressesShareABound) {
  Attempts attempts;
  int taken = 0;
  for (int i = 0; i < 5000; ++i)
    taken += attempts.take("10.0." + std::to_string(i / 250) + "." + std::to_string(i % 250), 1) ? 1 : 0;
  EXPECT_EQ(taken, 256 + 10);
}

TEST(Attempts, ANetworkOfIPv6IsOneSender) {
  Attempts attempts;
  int taken = 0;
  for (int i = 0; i < 100; ++i) taken += attempts.take("2001:db8::" + std::to_string(i), 1) ? 1 : 0;
  EXPECT_EQ(taken, 10);
  EXPECT_TRUE(attempts.take("2001:db8:0:1::1", 1));
}

TEST(Secret, AnEmptyOneMatchesNothing) {
  EXPECT_FALSE(sameSecret("", ""));
  EXPECT_TRUE(sameSecret(kGoodToken, kGoodToken));
  EXPECT_NE(randomCode(), randomCode());
  EXPECT_EQ(randomCode().size(), 32U);
}

TEST(HeaderText, ACookieIsFoundByItsWholeName) {
  EXPECT_EQ(cookieIn("a=1; palpate-viewer-80=x.y; b=2", "palpate-viewer-80"), "x.y");
  EXPECT_EQ(cookieIn("palpate-viewer-80=", "palpate-viewer-80"), "");
  for (const char* header : {"", ";;;", "palpate-viewer-8080=x", "xpalpate-viewer-80=x", "palpate-viewer-80"})
    EXPECT_EQ(cookieIn(header, "palpate-viewer-80"), "") << header;
  EXPECT_EQ(bearerIn("Bearer abc"), "abc");
  for (const char* header : {"", "Bearer", "Basic abc", "abc"}) EXPECT_EQ(bearerIn(header), "") << header;
}

}  // namespace
}  // namespace palpate::viewer
