// SPDX-License-Identifier: Apache-2.0
// The token, the cookie, the policy and TLS, at palpate-viewer as a process.
#include "palpate/testing/run_program.h"
#include "test_certificate.h"
#include "viewer_fixture.h"

namespace palpate::testing {
namespace {

constexpr const char* kViewerToken = "a-token-of-this-test-0123";
constexpr const char* kBearer = "Authorization: Bearer a-token-of-this-test-0123\r\n";

class ViewerLogin : public ViewerEndToEnd {
 protected:
  void startWithToken(std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--token-file", files_.write("token", std::string(kViewerToken) + "\n")});
    startViewer(more);
  }
  [[nodiscard]] std::string own() const { return "127.0.0.1:" + std::to_string(viewer_->port()); }
  [[nodiscard]] std::string origin() const { return "Origin: http://" + own() + "\r\n"; }
  [[nodiscard]] std::string ask(const std::string& line, const std::string& headers = "") const {
    return httpExchange(viewer_->port(), line + " HTTP/1.1\r\nHost: " + own() + "\r\nConnection: close\r\n" +
                                             headers + "\r\n");
  }
  [[nodiscard]] int open(const std::string& path, const std::string& headers,
                         std::optional<std::string> origin = std::nullopt) const {
    WsRequest request = this->request();
    request.path = path;
    request.headers = headers;
    request.origin = std::move(origin);
    return WsClient(request).status();
  }
  [[nodiscard]] static std::string cookieOf(const std::string& answer) {
    const std::size_t at = answer.find("set-cookie: ");
    return at == std::string::npos ? "" : answer.substr(at + 12, answer.find(';', at) - at - 12);
  }

  TemporaryFolder files_;
};

bool says(const std::string& answer, const std::string& part) {
  return answer.find(part) != std::string::npos;
}

TEST_F(ViewerLogin, ATokenInTheAddressLetsNobodyIn) {
  startWithToken();
  EXPECT_EQ(open(std::string("/ws?token=") + kViewerToken, ""), 401);
  EXPECT_EQ(open(std::string("/ws?token=") + kViewerToken, "", ""), 403);
  EXPECT_TRUE(says(ask(std::string("POST /login?token=") + kViewerToken), "HTTP/1.1 403"));
  EXPECT_TRUE(says(ask(std::string("GET /login?token=") + kViewerToken), R"({"needed":true})"));
}

TEST_F(ViewerLogin, AProgramBearsTheTokenInAHeader) {
  startWithToken();
  EXPECT_EQ(open("/ws", kBearer), 101);
  EXPECT_EQ(open("/ws", kBearer, ""), 101) << "a program has no Origin";
  EXPECT_EQ(open("/ws", kBearer, "http://evil.example"), 403);
  EXPECT_EQ(open("/ws", ""), 401);
  EXPECT_EQ(open("/ws", "Authorization: Bearer a-token-of-this-test-0124\r\n"), 401);
}

TEST_F(ViewerLogin, ABrowserGivesTheTokenOnceAndGetsACookie) {
  startWithToken();
  const std::string answer = ask("POST /login", origin() + kBearer);
  EXPECT_TRUE(says(answer, "HTTP/1.1 200")) << answer;
  EXPECT_TRUE(says(answer, "; Path=/; HttpOnly; SameSite=Strict")) << answer;
  EXPECT_FALSE(says(answer, kViewerToken)) << "the cookie is another secret";
  const std::string cookie = "Cookie: other=1; " + cookieOf(answer) + "\r\n";
  EXPECT_EQ(open("/ws", cookie), 101);
  EXPECT_TRUE(says(ask("GET /login", cookie), R"({"needed":false})"));
  EXPECT_EQ(open("/ws", cookie, "http://evil.example"), 403) << "browsers bring the cookie for any page";
  EXPECT_EQ(open("/ws", cookie, ""), 403);
  EXPECT_FALSE(
      says(ask("POST /login", std::string("Origin: http://evil.example\r\n") + kBearer), "set-cookie"));
}

TEST_F(ViewerLogin, ThePrintedAddressLetsOneBrowserIn) {
  startWithToken();
  const auto said = nlohmann::json::parse(viewer_->announcement());
  const std::string address = said["login_address"];
  const std::string base = said["address"];
  ASSERT_TRUE(address.starts_with(base + "#code=")) << address;
  EXPECT_FALSE(says(viewer_->announcement(), kViewerToken));
  const std::string code = "Authorization: Bearer " + address.substr(base.size() + 6) + "\r\n";
  EXPECT_EQ(open("/ws", code), 401) << "the code is for the login only";
  EXPECT_TRUE(says(ask("POST /login", origin() + code), "HTTP/1.1 200"));
  EXPECT_TRUE(says(ask("POST /login", origin() + code), "HTTP/1.1 401"));
}

TEST_F(ViewerLogin, WhoGuessesIsMadeToWait) {
  startWithToken();
  for (int i = 0; i < 10; ++i)
    EXPECT_TRUE(says(ask("POST /login", origin() + "Authorization: Bearer guess\r\n"), "HTTP/1.1 401")) << i;
  EXPECT_TRUE(says(ask("POST /login", origin() + "Authorization: Bearer guess\r\n"), "HTTP/1.1 429"));
  EXPECT_EQ(open("/ws", "Authorization: Bearer guess\r\n"), 429);
}

TEST_F(ViewerLogin, EveryAnswerSaysWhatThePageMayDo) {
  startWithToken();
  for (const std::string& answer :
       {ask("GET /"), ask("GET /nothing"), ask("GET /login"), ask("POST /login"), ask("PUT /"),
        ask("POST /login", "Content-Length: 4\r\n"), httpGet(viewer_->port(), "/", "evil.example"),
        httpGet(viewer_->port(), "/ws", own())}) {
    EXPECT_TRUE(says(answer, "content-security-policy: default-src 'none'; script-src 'self';")) << answer;
    EXPECT_TRUE(says(answer, "frame-ancestors 'none'")) << answer;
    EXPECT_FALSE(says(answer, "unsafe-")) << answer;
    for (const char* header : {"x-content-type-options: nosniff", "referrer-policy: no-referrer",
                               "cross-origin-opener-policy: same-origin"})
      EXPECT_TRUE(says(answer, header)) << answer;
  }
}

TEST_F(ViewerLogin, ABodyIsNotTakenForTheNextRequest) {
  startWithToken();
  const std::string second = "GET / HTTP/1.1\r\nHost: " + own() + "\r\n\r\n";
  const std::string length = "Content-Length: " + std::to_string(second.size()) + "\r\n\r\n";
  const std::string first = "POST /login HTTP/1.1\r\nHost: " + own() + "\r\n" + length;
  EXPECT_FALSE(says(httpExchange(viewer_->port(), first + second), "<title>"));
}

TEST_F(ViewerLogin, ManyCookiesOfOtherProgramsKeepNobodyOut) {
  startViewer();
  EXPECT_TRUE(says(ask("GET /", "Cookie: a=" + std::string(8000, 'x') + "\r\n"), "HTTP/1.1 200"));
}

TEST_F(ViewerLogin, BehindAProxyTheCookieIsForHttpsOnly) {
  startWithToken({"--origin", "https://viewer.example.org"});
  EXPECT_TRUE(says(viewer_->announcement(), "https://viewer.example.org/#code=")) << viewer_->announcement();
  const std::string login =
      " HTTP/1.1\r\nHost: viewer.example.org\r\nConnection: close\r\n" + std::string(kBearer);
  const auto from = [&](const std::string& origin) {
    return httpExchange(viewer_->port(), "POST /login" + login + "Origin: " + origin + "\r\n\r\n");
  };
  EXPECT_TRUE(says(from("https://viewer.example.org"), "SameSite=Strict; Secure"));
  EXPECT_TRUE(says(from("https://elsewhere.example.org"), "HTTP/1.1 403"));
}

TEST_F(ViewerLogin, UnderTlsOnlyTlsIsSpoken) {
  const TestCertificate own_certificate;
  startWithToken({"--tls-cert", own_certificate.certificate(), "--tls-key", own_certificate.key()});
  const std::uint16_t port = viewer_->port();
  const std::string host = " HTTP/1.1\r\nHost: " + own() + "\r\nOrigin: https://" + own() + "\r\n";
  const std::string get = "GET /" + host + "Connection: close\r\n\r\n";
  EXPECT_TRUE(says(viewer_->announcement(), "https://")) << viewer_->announcement();
  EXPECT_TRUE(says(tlsExchange(port, get), "<title>organ"));
  EXPECT_TRUE(says(tlsExchange(port, get, 0x0303), "<title>organ")) << "TLS 1.2";
  EXPECT_EQ(tlsExchange(port, get, 0x0302), "") << "TLS 1.1";
  EXPECT_EQ(httpExchange(port, get), "") << "plain http";
  EXPECT_TRUE(
      says(tlsExchange(port, "POST /login" + host + "Connection: close\r\n" + kBearer + "\r\n"), "; Secure"));
  const std::string upgrade = "GET /ws" + host + kBearer +
                              "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                              "Sec-WebSocket-Key: cGFscGF0ZS1wYWdlLTAwMQ==\r\n"
                              "Sec-WebSocket-Protocol: palpate.viewer.v1\r\n\r\n";
  EXPECT_TRUE(says(tlsExchange(port, upgrade, 0, 300), R"("type":"hello")"));
}

TEST(ViewerProgram, NamesTheTlsFileThatIsWrong) {
  const TemporaryFolder page;
  page.write("index.html", "x");
  const auto result =
      runProgram("palpate-viewer", {"--port", "0", "--page", page.path().string(), "--tls-cert",
                                    "/nowhere/cert.pem", "--tls-key", "/nowhere/key.pem"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("/nowhere/cert.pem"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace palpate::testing
