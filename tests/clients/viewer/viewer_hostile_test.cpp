// SPDX-License-Identifier: Apache-2.0
// Strangers and broken pages are shut out, and the others notice nothing.
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <functional>

#include "palpate/testing/run_program.h"
#include "viewer_fixture.h"

namespace palpate::testing {
namespace {

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

struct Attack {
  const char* name;
  std::function<void(WsClient&)> run;
  std::uint16_t code;
  bool may_reset{false};  // more is on its way when the viewer closes: the code may be lost
};

Attack saying(const char* name, std::string text, std::uint16_t code) {
  return {name, [text = std::move(text)](WsClient& c) { c.send(text); }, code};
}

// This many pieces of a message that does not end.
Attack inPieces(const char* name, int pieces, std::size_t size, std::uint16_t code) {
  const auto run = [=](WsClient& c) {
    for (int i = 0; i < pieces && c.send(std::string(size, 'x'), i == 0 ? 1 : 0, false); ++i) {
    }
  };
  return {name, run, code, true};
}

std::vector<Attack> attacks() {
  const std::string endless("\x81\xff\x40\0\0\0\0\0\0\0\1\2\3\4xxxx", 18);
  const auto flood = [](WsClient& c) {
    for (int i = 0; i < 2000 && c.send(std::string(R"({"type":"ping","t0":1})")); ++i) {
    }
  };
  return {
      saying("garbage", "garbage", 1008),
      saying("no UTF-8", "{\"type\":\"\xff\xfe\"}", 1008),
      saying("unknown type", R"({"type":"shutdown"})", 1008),
      saying("not a number", R"({"type":"target","position":[NaN,0,0]})", 1008),
      saying("out of this world", R"({"type":"target","position":[1e300,0,0]})", 1008),
      saying("a frame that was not sent", R"({"type":"ack","seq":4000000})", 1008),
      {"binary", [](WsClient& c) { c.send(std::string(100, '\0'), 2); }, 1003},
      {"5 kB", [](WsClient& c) { c.send(std::string(5000, 'x')); }, 1009, true},
      {"promises 2^62 bytes", [=](WsClient& c) { c.sendRaw(endless); }, 1009, true},
      {"flood", flood, 1008, true},
      inPieces("pieces without end", 50, 200, 1009),
      inPieces("empty pieces without end", 4000, 0, 1008),
  };
}

TEST_F(ViewerEndToEnd, AHostilePageIsShutOutWhileAnotherGoesOn) {
  const auto good = openServedPage();
  for (const Attack& attack : attacks()) {
    TestPage hostile(request());
    ASSERT_EQ(hostile.client.status(), 101) << attack.name;
    attack.run(hostile.client);
    hostile.listen(seconds(5));
    EXPECT_TRUE(hostile.closed) << attack.name;
    const bool reset = attack.may_reset && hostile.close_code == 0;
    EXPECT_TRUE(reset || hostile.close_code == attack.code) << attack.name << ": " << hostile.close_code;
    EXPECT_TRUE(goesOn(*good)) << attack.name;
  }
  EXPECT_TRUE(viewer_->running());
}

TEST_F(ViewerEndToEnd, AMessageMayComeInPieces) {
  startViewer();
  const auto page = openPage();
  constexpr int kMessages = 40;  // 880 pieces, more than messages are allowed
  const std::string ping = R"({"type":"ping","t0":1})";
  for (int i = 0; i < kMessages; ++i)
    for (std::size_t at = 0; at < ping.size(); ++at)
      page->client.send(ping.substr(at, 1), at == 0 ? 1 : 0, at + 1 == ping.size());
  page->texts.erase("pong");
  page->client.say({{"type", "ping"}, {"t0", 77}});
  EXPECT_TRUE(page->listen(seconds(5), [&] { return page->has("pong") && page->texts["pong"]["t0"] == 77; }));
  EXPECT_FALSE(page->closed);
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

TEST_F(ViewerEndToEnd, FilesComeAndNothingElseComes) {
  startViewer();
  const std::string own = "127.0.0.1:" + std::to_string(viewer_->port());
  const auto get = [&](const std::string& path) { return httpGet(viewer_->port(), path, own); };
  const std::string page = get("/");
  EXPECT_TRUE(page.starts_with("HTTP/1.1 200")) << page;
  EXPECT_NE(page.find("<title>organ"), std::string::npos);
  EXPECT_NE(get("/nothing").find("404"), std::string::npos);
  EXPECT_NE(httpGet(viewer_->port(), "/", "evil.example").find("403"), std::string::npos);
  for (const char* path :
       {"/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/..%2f..%2fetc/passwd", "//etc/passwd"})
    EXPECT_EQ(get(path).find("root:"), std::string::npos) << path;
}

TEST_F(ViewerEndToEnd, EndsWithCodeZeroWhenAsked) {
  const auto page = openServedPage();
  EXPECT_EQ(viewer_->end(SIGTERM), 0);
  page->listen(seconds(5));
  EXPECT_TRUE(page->closed);
}

TEST(ViewerProgram, SaysWhyItDoesNotStart) {
  const auto open = runProgram("palpate-viewer", {"--port", "0", "--page", "/nowhere"});
  EXPECT_EQ(open.exit_code, 2);
  EXPECT_NE(open.err.find("index.html"), std::string::npos) << open.err;
  const TemporaryFolder page;
  page.write("index.html", "x");
  const auto without =
      runProgram("palpate-viewer", {"--listen", "0.0.0.0", "--port", "0", "--page", page.path().string()});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_NE(without.err.find("--token-file"), std::string::npos) << without.err;
}

TEST(ViewerProgram, ASettingThatCannotBeUsedIsTheCommandLinesFault) {
  const TemporaryFolder page;
  page.write("index.html", "x");
  const std::string short_token = page.write("token", "short").string();
  const auto expect = [&](const std::vector<std::string>& words, const std::string& part) {
    std::vector<std::string> arguments{"--port", "0", "--page", page.path().string()};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const auto result = runProgram("palpate-viewer", arguments);
    EXPECT_EQ(result.exit_code, 2) << part;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
  };
  expect({"--token-file", "/nowhere/token"}, "--token-file: cannot read a token from /nowhere/token");
  expect({"--token-file", short_token}, "the token has 5 characters");
  expect({"--origin", "viewer"}, "--origin is 'viewer'");
  expect({"--listen", "localhost"}, "--listen is 'localhost'");
  expect({"--export", page.path().string()}, "core/palpate_core.mjs");
}

TEST_F(ViewerEndToEnd, APortThatIsTakenIsAFailure) {
  startViewer();
  const TemporaryFolder page;
  page.write("index.html", "x");
  const auto second = runProgram("palpate-viewer",
                                 {"--port", std::to_string(viewer_->port()), "--page", page.path().string()});
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_NE(second.err.find("is the port in use"), std::string::npos) << second.err;
}

}  // namespace
}  // namespace palpate::testing
