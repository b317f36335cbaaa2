// SPDX-License-Identifier: Apache-2.0
// What a page reads of a model and hands over.
#include "core/data/array_reader.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "core/data/load_error.h"

namespace palpate::testing {

namespace {

constexpr Dataset<float> kPairs{"near/scale", {"M", "Cm"}, "m"};

/// A reader that has one array.
struct Pairs {
  ArrayReader reader{"page.h5"};
  Pairs(std::vector<std::uint64_t> shape, std::size_t numbers);
};

Pairs::Pairs(std::vector<std::uint64_t> shape, std::size_t numbers) {
  const std::vector<float> values(numbers, 0.5F);
  std::memcpy(reader.addArray("near/scale", NumberType::kF32, std::move(shape), 4 * numbers), values.data(),
              4 * numbers);
}

template <class Work>
std::string complaintOf(Work&& work) {
  try {
    work();
  } catch (const LoadError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST(ArrayReader, GivesBackWhatItGot) {
  Pairs pairs({2, 3}, 6);
  ArrayReader& reader = pairs.reader;
  reader.addAttribute("law", std::string("stvk"));
  reader.addAttribute("order", std::vector<double>{3.0});
  reader.addAttribute("load_direction", std::vector<double>{0.0, 0.6, 0.8});
  Lengths lengths;
  const std::span<const float> found = reader.dataset(kPairs, lengths);
  ASSERT_EQ(found.size(), 6U);
  EXPECT_EQ(found[5], 0.5F);
  EXPECT_EQ(lengths.value("M"), 2U);
  EXPECT_EQ(lengths.value("Cm"), 3U);
  EXPECT_EQ(reader.text("law"), "stvk");
  EXPECT_EQ(reader.integer("order"), 3);
  std::array<double, 3> direction{};
  reader.numbers("load_direction", direction);
  EXPECT_EQ(direction[2], 0.8);
  EXPECT_TRUE(reader.hasAttribute("law"));
  EXPECT_FALSE(reader.hasAttribute("E"));
  EXPECT_FALSE(reader.hasDataset("near/node"));
}

TEST(ArrayReader, HasAPlaceForAnArrayOfNothing) {
  ArrayReader reader("page.h5");
  EXPECT_NE(reader.addArray("near/node", NumberType::kI32, {2}, 8), nullptr);
  EXPECT_NE(reader.addArray("near/scale", NumberType::kF32, {2, 0}, 0), nullptr);
  Lengths lengths;
  EXPECT_TRUE(reader.dataset(kPairs, lengths).empty());
}

TEST(ArrayReader, KeepsItsArraysAsLongAsItsMemoryIsHeld) {
  std::shared_ptr<const void> memory;
  std::span<const float> found;
  {
    const Pairs pairs({2, 3}, 6);
    const ArrayReader& reader = pairs.reader;
    Lengths lengths;
    found = reader.dataset(kPairs, lengths);
    memory = reader.memory();
  }
  EXPECT_EQ(found[0], 0.5F);
}

TEST(ArrayReader, RefusesInOneSentence) {
  const auto asked = [](const ArrayReader& reader, const char* rows) {
    Lengths lengths;
    lengths.define("M", static_cast<std::uint64_t>(std::stoi(rows)));
    return complaintOf([&] { (void)reader.dataset(kPairs, lengths); });
  };
  EXPECT_EQ(asked(Pairs({2, 3}, 6).reader, "3"), "page.h5: /near/scale has shape 2 x 3, expected 3 x Cm");
  EXPECT_EQ(asked(Pairs({2, 3}, 5).reader, "2"),
            "page.h5: /near/scale has more numbers than the file's 20 bytes can hold");
  EXPECT_EQ(asked(Pairs({2, 2}, 5).reader, "2"), "page.h5: /near/scale has 20 bytes, expected 16");
  EXPECT_EQ(asked(ArrayReader("page.h5"), "2"), "page.h5: /near/scale is missing");
  const Pairs pairs({2, 3}, 6);
  const ArrayReader& reader = pairs.reader;
  EXPECT_EQ(complaintOf([&] { (void)reader.number("E"); }), "page.h5: attribute E is missing");
  Lengths lengths;
  EXPECT_EQ(complaintOf([&] {
              (void)reader.dataset(Dataset<std::int32_t>{"near/scale", {"M", "Cm"}, ""}, lengths);
            }),
            "page.h5: /near/scale has numbers of another type than expected");
}

}  // namespace palpate::testing
