// SPDX-License-Identifier: Apache-2.0
// Messages of a page that are taken, and messages that are refused.
#include "page_message.h"

#include <gtest/gtest.h>

#include <string>

namespace palpate::viewer {
namespace {

template <class T>
T parsed(const char* text) {
  const auto message = parsePageMessage(text);
  if (!message || !std::holds_alternative<T>(*message)) {
    ADD_FAILURE() << text;
    return T{};
  }
  return std::get<T>(*message);
}

TEST(PageMessage, EachTypeIsRead) {
  EXPECT_EQ(parsed<Ack>(R"({"type":"ack","seq":7})").seq, 7U);
  EXPECT_EQ(parsed<Ping>(R"({"type":"ping","t0":12.5})").t0, 12.5);
  (void)parsed<Grab>(R"({"type":"grab"})");
  (void)parsed<Release>(R"({"type":"release","why":"finger lifted"})");
  EXPECT_EQ(parsed<Target>(R"({"type":"target","position":[1,-2.5,3e-3],"seq":4})").position[1], -2.5);
  EXPECT_EQ(parsed<SetRate>(R"({"type":"rate","hz":0})").hz, 0.0);
  const auto wanted = parsed<SetParameters>(R"({"type":"set","request":3,"youngs_factor":0.5})");
  EXPECT_EQ(wanted.request, 3U);
  EXPECT_EQ(wanted.youngs_modulus, 0.5);
  EXPECT_FALSE(wanted.friction.has_value());
}

class Garbage : public ::testing::TestWithParam<const char*> {};

TEST_P(Garbage, IsRefused) {
  EXPECT_FALSE(parsePageMessage(GetParam()).has_value()) << GetParam();
}

INSTANTIATE_TEST_SUITE_P(
    Texts, Garbage,
    ::testing::Values(
        "", "{", "garbage", "[]", "17", "null", R"({"seq":1})", R"({"type":7})", R"({"type":"unknown"})",
        R"({"type":"ack"})", R"({"type":"ack","seq":-1})", R"({"type":"ack","seq":1.5})",
        R"({"type":"ack","seq":4294967296})", R"({"type":"ack","seq":"1"})", R"({"type":"ping"})",
        R"({"type":"ping","t0":1e999})", R"({"type":"ping","t0":null})", R"({"type":"target"})",
        R"({"type":"target","position":[1,2]})", R"({"type":"target","position":[1,2,3,4]})",
        R"({"type":"target","position":[1,2,NaN]})", R"({"type":"target","position":[1,2,null]})",
        R"({"type":"target","position":[1,2,1e6]})", R"({"type":"target","position":{"x":1}})",
        R"({"type":"rate","hz":-1})", R"({"type":"rate","hz":1001})", R"({"type":"set"})",
        R"({"type":"set","request":1,"friction":"much"})", R"({"type":"set","request":1,"friction":-0.1})",
        R"({"type":"set","request":1,"youngs_factor":0})", "{\"type\":\"\xff\xfe\"}"));

TEST(PageMessage, TooLongOrDeepIsRefusedWithoutHarm) {
  EXPECT_FALSE(parsePageMessage(R"({"type":"grab","x":")" + std::string(kMaxMessage, 'x') + "\"}"));
  EXPECT_FALSE(parsePageMessage(std::string(kMaxMessage, '[')));
}

}  // namespace
}  // namespace palpate::viewer
