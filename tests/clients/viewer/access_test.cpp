// SPDX-License-Identifier: Apache-2.0
// Who may connect.
#include "access.h"

#include <gtest/gtest.h>

#include "palpate/client/error.h"

namespace palpate::viewer {
namespace {

constexpr const char* kToken = "0123456789abcdef-_X";

AccessOptions local() {
  return {"127.0.0.1", 8080, "", {}};
}

AccessOptions open() {
  return {"0.0.0.0", 8080, kToken, {}};
}

TEST(Access, OtherMachinesNeedAToken) {
  EXPECT_NO_THROW(check(local()));
  EXPECT_NO_THROW(check({"::1", 8080, "", {}}));
  EXPECT_NO_THROW(check(open()));
  for (const char* address : {"0.0.0.0", "192.168.1.5", "::", "fe80::1"})
    EXPECT_THROW(check({address, 8080, "", {}}), client::ClientError) << address;
}

TEST(Access, RefusesWhatCannotBeAnAddressATokenOrAnOrigin) {
  for (const char* address : {"localhost", "", "127.0.0", "eth0"})
    EXPECT_THROW(check({address, 8080, kToken, {}}), client::ClientError) << address;
  for (const char* token : {"short", "0123456789 abcdef", "0123456789abcde&f", "0123456789abcde\xc3\xa4"})
    EXPECT_THROW(check({"127.0.0.1", 8080, token, {}}), client::ClientError) << token;
  EXPECT_THROW(check({"127.0.0.1", 8080, std::string(129, 'a'), {}}), client::ClientError);
  for (const char* origin : {"viewer.example.org", "https://", "ftp://x", "https://x/path", "https://u@x"})
    EXPECT_THROW(check({"127.0.0.1", 8080, "", {origin}}), client::ClientError) << origin;
}

TEST(Access, OnlyThisMachinesOwnNamesAreItsHosts) {
  const AccessRules rules(local());
  for (const char* host :
       {"127.0.0.1:8080", "localhost:8080", "LOCALHOST:8080", "[::1]:8080", "127.0.0.9:8080"})
    EXPECT_TRUE(rules.hostAllowed(host)) << host;
  for (const char* host :
       {"", "127.0.0.1", "127.0.0.1:8081", "evil.example:8080", "localhost.evil.example:8080",
        "192.168.1.5:8080", "127.0.0.1:8080@evil", "[::1", "localhost:80800"})
    EXPECT_FALSE(rules.hostAllowed(host)) << host;
}

TEST(Access, FromOutsideANumericAddressIsOurs) {
  const AccessRules rules(open());
  EXPECT_TRUE(rules.hostAllowed("192.168.1.5:8080"));
  EXPECT_TRUE(rules.hostAllowed("[fe80::1]:8080"));
  EXPECT_FALSE(rules.hostAllowed("rebound.example:8080")) << "a name that was bent to point here";
}

TEST(Access, APageOfAnotherSiteIsRefused) {
  const AccessRules rules(local());
  EXPECT_EQ(rules.refusal({"127.0.0.1:8080", "http://127.0.0.1:8080"}), nullptr);
  for (const char* origin :
       {"", "null", "http://evil.example", "https://127.0.0.1:8080", "http://127.0.0.1:8081",
        "http://localhost:8080", "http://127.0.0.1:8080.evil.example"})
    EXPECT_NE(rules.refusal({"127.0.0.1:8080", origin}), nullptr) << origin;
  EXPECT_NE(rules.refusal({"evil.example:8080", "http://evil.example:8080"}), nullptr);
}

TEST(Access, AProgramWithoutAnOriginNeedsAToken) {
  const char* host = "192.168.1.5:8080";
  EXPECT_EQ(AccessRules(open()).refusal({host, "http://192.168.1.5:8080"}), nullptr);
  EXPECT_EQ(AccessRules(open()).refusal({host, "", true}), nullptr) << "the token itself is judged by Login";
  EXPECT_NE(AccessRules(open()).refusal({host, ""}), nullptr) << "a program with a cookie";
  EXPECT_NE(AccessRules(open()).refusal({host, "http://evil.example", true}), nullptr)
      << "a stolen token in another page";
  EXPECT_NE(AccessRules(local()).refusal({"127.0.0.1:8080", "", true}), nullptr)
      << "there is no token to bear";
}

TEST(Access, UnderTlsOurOriginIsHttps) {
  AccessOptions options = open();
  options.tls = true;
  const AccessRules rules(options);
  EXPECT_EQ(rules.refusal({"192.168.1.5:8080", "https://192.168.1.5:8080"}), nullptr);
  EXPECT_NE(rules.refusal({"192.168.1.5:8080", "http://192.168.1.5:8080"}), nullptr);
  options.port = 443;
  EXPECT_TRUE(AccessRules(options).hostAllowed("192.168.1.5"));
  options.port = 80;
  EXPECT_FALSE(AccessRules(options).hostAllowed("192.168.1.5"));
}

TEST(Access, AFurtherOriginComesInUnderItsOwnName) {
  const AccessRules rules({"127.0.0.1", 8080, "", {"https://viewer.example.org"}});
  EXPECT_EQ(rules.refusal({"viewer.example.org", "https://viewer.example.org"}), nullptr);
  EXPECT_EQ(rules.refusal({"127.0.0.1:8080", "https://viewer.example.org"}), nullptr)
      << "proxies may set Host";
  EXPECT_NE(rules.refusal({"viewer.example.org", "https://evil.example.org"}), nullptr);
}

}  // namespace
}  // namespace palpate::viewer
