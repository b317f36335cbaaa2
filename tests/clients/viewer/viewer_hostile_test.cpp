// SPDX-License-Identifier: Apache-2.0
// Strangers and broken pages are shut out, and the others notice nothing.
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <functional>

#include "../run_program.h"
#include "viewer_fixture.h"

namespace palpate::testing {
namespace {

constexpr const char* kToken = "a-token-of-this-test-0123";

TEST_F(ViewerEndToEnd, WhoeverIsNotOurPageIsRefused) {
  startViewer();
  const auto statusOf = [&](auto change) {
    WsRequest request = this->request();
    change(request);
    return WsClient(request).status();
  };
  EXPECT_EQ(statusOf([](WsRequest&) {}), 101);
  EXPECT_EQ(statusOf([](WsRequest& r) { r.origin = "http://evil.example"; }), 403);
  EXPECT_EQ(statusOf([](WsRequest& r) { r.origin = "null"; }), 403);
  EXPECT_EQ(statusOf([](WsRequest& r) { r.origin = ""; }), 403);
  EXPECT_EQ(statusOf([](WsRequest& r) { r.host = "evil.example:" + std::to_string(r.port); }), 403);
  EXPECT_EQ(statusOf([](WsRequest& r) { r.subprotocol = ""; }), 400);
  EXPECT_EQ(statusOf([](WsRequest& r) { r.subprotocol = "http"; }), 400);
  EXPECT_EQ(statusOf([](WsRequest& r) { r.path = "/other"; }), 404);
}

TEST_F(ViewerEndToEnd, AHostilePageIsShutOutWhileAnotherGoesOn) {
  startServer();
  startViewer();
  const auto good = openPage();
  ASSERT_TRUE(good->connect());
  using Attack = std::function<void(WsClient&)>;
  const std::vector<std::tuple<std::string, Attack, std::uint16_t>> attacks{
      {"garbage", [](WsClient& c) { c.send(std::string("garbage")); }, 1008},
      {"no UTF-8", [](WsClient& c) { c.send(std::string("{\"type\":\"\xff\xfe\"}")); }, 1008},
      {"unknown type", [](WsClient& c) { c.send(std::string(R"({"type":"shutdown"})")); }, 1008},
      {"not a number", [](WsClient& c) { c.send(std::string(R"({"type":"target","position":[NaN,0,0]})")); },
       1008},
      {"out of this world",
       [](WsClient& c) { c.send(std::string(R"({"type":"target","position":[1e300,0,0]})")); }, 1008},
      {"a frame that was not sent",
       [](WsClient& c) { c.send(std::string(R"({"type":"ack","seq":4000000})")); }, 1008},
      {"binary", [](WsClient& c) { c.send(std::string(100, '\0'), 2); }, 1003},
      {"5 kB", [](WsClient& c) { c.send(std::string(5000, 'x')); }, 1009},
      {"promises 2^62 bytes",
       [](WsClient& c) { c.sendRaw(std::string("\x81\xff\x40\0\0\0\0\0\0\0\1\2\3\4xxxx", 18)); }, 1009},
      {"flood",
       [](WsClient& c) {
         for (int i = 0; i < 2000 && c.send(std::string(R"({"type":"ping","t0":1})")); ++i) {
         }
       },
       1008},
      {"pieces without end",
       [](WsClient& c) {
         for (int i = 0; i < 50 && c.send(std::string(200, 'x'), i == 0 ? 1 : 0, false); ++i) {
         }
       },
       1009},
  };
  for (const auto& [name, attack, code] : attacks) {
    TestPage hostile(request());
    ASSERT_EQ(hostile.client.status(), 101) << name;
    attack(hostile.client);
    hostile.listen(seconds(5));
    EXPECT_TRUE(hostile.closed) << name;
    // 0: reset, because more was under way
    EXPECT_TRUE(hostile.close_code == code || hostile.close_code == 0) << name << ": " << hostile.close_code;
    EXPECT_TRUE(goesOn(*good)) << name;
  }
  EXPECT_TRUE(viewer_->running());
}

TEST_F(ViewerEndToEnd, NoMorePagesThanAllowedAndAPlaceThatIsLeftIsFree) {
  startViewer({"--max-pages", "2"});
  auto first = openPage();
  const auto second = openPage();
  EXPECT_EQ(first->client.status(), 101);
  EXPECT_EQ(second->client.status(), 101);
  EXPECT_EQ(openPage()->client.status(), 503);
  first.reset();
  second->listen(milliseconds(300));
  EXPECT_EQ(openPage()->client.status(), 101);
}

TEST_F(ViewerEndToEnd, HalfARequestHoldsNobodyUp) {
  startViewer();
  std::vector<int> idle;
  for (int i = 0; i < 40; ++i) {
    idle.push_back(connectTo(viewer_->port()));
    EXPECT_EQ(::send(idle.back(), "GET / HT", 8, MSG_NOSIGNAL), 8);
  }
  const auto page = openPage();
  EXPECT_EQ(page->client.status(), 101);
  EXPECT_TRUE(page->listen(seconds(5), [&] { return page->has("hello"); }));
  for (const int fd : idle) close(fd);
}

TEST_F(ViewerEndToEnd, WithATokenOnlyItsBearersComeIn) {
  startViewer({"--token", kToken});
  const auto statusOf = [&](const std::string& path, std::optional<std::string> origin = std::nullopt) {
    WsRequest request = this->request();
    request.path = path;
    request.origin = std::move(origin);
    return WsClient(request).status();
  };
  EXPECT_EQ(statusOf("/ws"), 403);
  EXPECT_EQ(statusOf("/ws?token=a-token-of-this-test-0124"), 403);
  EXPECT_EQ(statusOf(std::string("/ws?token=") + kToken), 101);
  EXPECT_EQ(statusOf(std::string("/ws?token=") + kToken, ""), 101) << "a program without an Origin";
  EXPECT_EQ(statusOf(std::string("/ws?token=") + kToken, "http://evil.example"), 403);
}

TEST_F(ViewerEndToEnd, FilesComeWithTheirPolicyAndNothingElseComes) {
  startViewer();
  const std::string own = "127.0.0.1:" + std::to_string(viewer_->port());
  const auto get = [&](const std::string& path) { return httpGet(viewer_->port(), path, own); };
  const std::string page = get("/");
  EXPECT_TRUE(page.starts_with("HTTP/1.1 200")) << page;
  EXPECT_NE(page.find("<title>organ"), std::string::npos);
  EXPECT_NE(page.find("Content-Security-Policy: default-src 'self'; connect-src 'self' ws://" + own),
            std::string::npos);
  EXPECT_NE(page.find("X-Content-Type-Options: nosniff"), std::string::npos);
  EXPECT_NE(get("/nothing").find("404"), std::string::npos);
  EXPECT_NE(httpGet(viewer_->port(), "/", "evil.example").find("403"), std::string::npos);
  for (const char* path :
       {"/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/..%2f..%2fetc/passwd", "//etc/passwd"})
    EXPECT_EQ(get(path).find("root:"), std::string::npos) << path;
}

TEST_F(ViewerEndToEnd, EndsWithCodeZeroWhenAsked) {
  startServer();
  startViewer();
  const auto page = openPage();
  ASSERT_TRUE(page->connect());
  EXPECT_EQ(viewer_->end(SIGTERM), 0);
  page->listen(seconds(5));
  EXPECT_TRUE(page->closed);
}

TEST(ViewerProgram, SaysWhyItDoesNotStart) {
  const auto open =
      runProgram("palpate-viewer", {"--listen", "0.0.0.0", "--port", "0", "--page", "/nowhere"});
  EXPECT_EQ(open.exit_code, 1);
  EXPECT_NE(open.err.find("index.html"), std::string::npos) << open.err;
  const std::filesystem::path page = std::filesystem::temp_directory_path() / "palpate-viewer-start";
  std::filesystem::create_directories(page);
  std::ofstream(page / "index.html") << "x";
  const auto without =
      runProgram("palpate-viewer", {"--listen", "0.0.0.0", "--port", "0", "--page", page.string()});
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_NE(without.err.find("--token"), std::string::npos) << without.err;
  std::filesystem::remove_all(page);
}

}  // namespace
}  // namespace palpate::testing
