// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "list_report.h"

namespace palpate::list {
namespace {

Server serverOf(std::uint32_t id, bool answers_any) {
  Server server;
  server.status.server_id = id;
  server.status.session = 0xabc;
  server.status.answers_any = answers_any;
  server.status.rate_hz = 1000.0;
  server.status.tools = 2;
  server.status.tip_radius[0] = server.status.tip_radius[1] = 0.005;
  dds::assignText(server.status.host, "bench");
  server.organs = {{7, 0xabc, "cafe", 100, 196, 60, {0.2, 0.1, 0.05}, {{"nodule", 20e3}}}};
  server.devices[0] = "touch";
  return server;
}

Publisher driver(std::uint32_t tool, std::uint32_t server) {
  return {true, tool, server, 1000, 999.6, {"palpate-tool", "77", "bench"}};
}

TEST(List, APublisherIsForTheServerThatTakesItsPoses) {
  const Server open = serverOf(0, true), named = serverOf(3, false);
  EXPECT_TRUE(isFor(driver(0, 0), open));
  EXPECT_TRUE(isFor(driver(0, dds::kServerAny), open));
  EXPECT_FALSE(isFor(driver(0, 3), open));
  EXPECT_TRUE(isFor(driver(0, 3), named));
  EXPECT_FALSE(isFor(driver(0, dds::kServerAny), named)) << "it answers only poses that name it";
  Publisher silent = driver(0, 0);
  silent.sends = false;
  EXPECT_FALSE(isFor(silent, open));
}

TEST(List, ShowsEachToolWithWhoDrivesIt) {
  const Listing listing{7, {serverOf(0, true)}, {driver(0, dds::kServerAny), driver(5, 0)}};
  const std::string text = textOf(listing);
  for (const char* part :
       {"DDS domain 7: 1 servers, 2 publishers of poses\n", "server 0, session 0000000000000abc, on bench",
        "organ 7   100 surface nodes, 60 accessible, 196 triangles, 200 x 100 x 50 mm, model cafe",
        "nodule, E 20 kPa", "tool 0    touch      tip 5.0 mm, palpate-tool (77) on bench, 1000 poses/s\n",
        "tool 1    ?          tip 5.0 mm, nobody sends\n",
        "palpate-tool (77) on bench sends poses of tool 5 for server 0, which nobody takes\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
}

TEST(List, SaysNullWhereNothingIsKnown) {
  Publisher silent = driver(0, 0);
  silent.sends = false;
  const program::Json json = jsonOf({7, {serverOf(0, true)}, {driver(1, dds::kServerAny), silent}});
  EXPECT_TRUE(json.at("servers")[0].at("tools")[1].at("device").isNull());
  EXPECT_EQ(json.at("servers")[0].at("tools")[0].at("device").text(), "touch");
  EXPECT_EQ(json.at("servers")[0].at("organs")[0].at("surface_nodes").get<int>(), 100);
  EXPECT_TRUE(json.at("publishers")[0].at("server_id").isNull());
  EXPECT_EQ(json.at("publishers")[0].at("tool_id").get<int>(), 1);
  EXPECT_TRUE(json.at("publishers")[1].at("tool_id").isNull());
}

}  // namespace
}  // namespace palpate::list
