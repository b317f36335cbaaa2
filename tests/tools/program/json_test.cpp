// SPDX-License-Identifier: Apache-2.0
#include "tools/program/json.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace palpate::program {
namespace {

TEST(Json, IsWrittenWithSortedKeys) {
  const Json json{{"b", 1}, {"a", {{"y", true}, {"x", nullptr}}}, {"c", std::array{1.0, 2.5}}};
  EXPECT_EQ(json.dump(), R"({"a":{"x":null,"y":true},"b":1,"c":[1.0,2.5]})");
  EXPECT_EQ(json.dump(-1, Keys::kAsWritten), R"({"b":1,"a":{"y":true,"x":null},"c":[1.0,2.5]})");
  EXPECT_EQ(Json({{"a", Json::array()}, {"b", Json::object()}}).dump(2), "{\n  \"a\": [],\n  \"b\": {}\n}");
}

TEST(Json, NumbersKeepAllTheirDigits) {
  EXPECT_EQ(Json(0.1).dump(), "0.1");
  EXPECT_EQ(Json(std::numeric_limits<std::uint64_t>::max()).dump(), "18446744073709551615");
  EXPECT_EQ(Json(std::numeric_limits<std::int64_t>::min()).dump(), "-9223372036854775808");
  const double third = 1.0 / 3.0;
  EXPECT_EQ(Json::parse(Json(third).dump()).get<double>(), third);
}

TEST(Json, WhatItCannotHoldIsReplaced) {
  EXPECT_EQ(Json(std::array{double{NAN}, double{-INFINITY}}).dump(), "[null,null]");
  EXPECT_EQ(Json("liver\xff").dump(), "\"liver\xef\xbf\xbd\"");
}

TEST(Json, GrowsByKeysAndEntries) {
  Json json;
  json["list"].push_back(1);
  json["list"].push_back("two");
  json["list"] = json["list"];
  EXPECT_EQ(json.dump(), R"({"list":[1,"two"]})");
  EXPECT_THROW(json.push_back(3), JsonError);
  EXPECT_THROW(json["list"]["key"] = 3, JsonError);
}

TEST(Json, IsRead) {
  const Json json =
      Json::parse(R"({"n": 3, "m": -3, "x": 1e-3, "t": "text", "b": false, "a": [1, [2]], "z": null})");
  EXPECT_EQ(json["n"].get<int>(), 3);
  EXPECT_TRUE(json["n"].isUnsigned());
  EXPECT_FALSE(json["m"].isUnsigned());
  EXPECT_FALSE(json["x"].isWhole());
  EXPECT_EQ(json["x"].get<double>(), 1e-3);
  EXPECT_EQ(json["t"].get<std::string>(), "text");
  EXPECT_FALSE(json["b"].get<bool>());
  EXPECT_EQ(json["a"][1][0].get<std::size_t>(), 2U);
  EXPECT_TRUE(json.at("z").isNull());
  EXPECT_EQ(json.find("gone"), nullptr);
  EXPECT_THROW((void)json.at("gone"), JsonError);
  EXPECT_THROW((void)json["t"].get<double>(), JsonError);
  EXPECT_THROW((void)json["a"][2], JsonError);
}

TEST(Json, RefusesMalformedText) {
  for (const char* text : {"", "{", "{\"a\":}", "nul", "{} x"}) {
    EXPECT_FALSE(Json::read(text)) << text;
    EXPECT_THROW((void)Json::parse(text), JsonError) << text;
  }
}

TEST(Json, RefusesWhatIsNestedTooDeep) {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_TRUE(Json::read(nested(100)));
  EXPECT_FALSE(Json::read(nested(200'000)));
}

TEST(Json, EqualsWhateverTheOrderOfKeys) {
  EXPECT_EQ(Json::parse(R"({"a": 1, "b": [1.0, 2]})"), (Json{{"b", std::array{1, 2}}, {"a", 1}}));
  EXPECT_FALSE(Json(1) == Json("1"));
  EXPECT_FALSE(Json(true) == Json(1));
  EXPECT_FALSE((Json{{"a", 1}} == Json{{"a", 1}, {"b", 1}}));
}

}  // namespace
}  // namespace palpate::program
