// SPDX-License-Identifier: Apache-2.0
// A process that parses model files and lies.
#include "core/data/model_answer.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <fstream>
#include <random>

#include "../load_case.h"
#include "core/data/ask_reader.h"
#include "core/data/model_checks.h"
#include "core/data/model_reader.h"

namespace palpate::testing {

namespace {

constexpr std::size_t kFileBytes = 4096;

/// A copy of a file of kFileBytes that nobody parses.
const SealedImage& anyImage() {
  static const SealedImage image = [] {
    const TemporaryFile file("any.h5");
    std::ofstream(file.path()) << std::string(kFileBytes, 'x');
    return SealedImage(file.path());
  }();
  return image;
}

std::string complaintOf(const std::string& answer, const SealedImage& image = anyImage()) {
  try {
    (void)readModel(AnsweredModel(image, "model.h5", answer), "model.h5");
    return {};
  } catch (const LoadError& error) {
    return error.what();
  }
}

struct Lie : LoadCase {
  std::string answer;
};

class AnswerIsNotBelieved : public ::testing::TestWithParam<Lie> {};

TEST_P(AnswerIsNotBelieved, WithOneClearLine) {
  EXPECT_EQ(complaintOf(GetParam().answer), "model.h5: " + GetParam().expected);
}

std::string array(std::vector<std::uint64_t> lengths, std::uint64_t offset) {
  ModelAnswer answer;
  answer.addArray("a", {NumberType::kF64, std::move(lengths)}, offset);
  return answer.whole();
}

std::string two(std::uint64_t second, const char* path) {
  ModelAnswer answer;
  answer.addArray("a", {NumberType::kF64, {9}}, 1024);
  answer.addArray(path, {NumberType::kI8, {64}}, second);
  return answer.whole();
}

std::string text(const std::string& value) {
  ModelAnswer answer;
  answer.addText("format", value);
  return answer.whole();
}

/// Other bytes in the place of those that are at the end of an answer.
std::string ending(std::string answer, const std::string& bytes) {
  return answer.replace(answer.size() - bytes.size(), bytes.size(), bytes);
}

std::string number(std::uint64_t value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

Lie lie(const char* name, const std::string& expected, std::string answer) {
  return {{name, "the answer of the process that parses it is not to be believed: " + expected},
          std::move(answer)};
}

std::vector<Lie> lies() {
  const std::string within = ", expected within the file's 4096";
  const std::string one = array({1}, 0);  // ..., type, rank, length, offset, end
  std::string type = one;
  type[type.size() - 26] = 8;
  std::string kind = one;
  kind[21] = 'X';
  return {
      lie("BeyondTheEnd", "/a lies at bytes 4096 + 8" + within, array({1}, 4096)),
      lie("OverTheEnd", "/a lies at bytes 4032 + 72" + within, array({9}, 4032)),
      lie("OffsetThatOverflows", "/a lies at bytes 18446744073709551552 + 128" + within,
          array({16}, 0 - std::uint64_t{64})),
      lie("SizeThatOverflows", "/a has no size", array({1ULL << 32U, 1ULL << 32U}, 0)),
      lie("SizeThatOverflowsToLittle", "/a has no size", array({(1ULL << 61U) + 1}, 0)),
      lie("Unaligned", "/a begins at byte 8, expected a multiple of 64", array({1}, 8)),
      lie("MoreDimensionsThanThereAre", "it ends too early", array({1, 1, 1, 1, 1}, 0)),
      lie("Twice", "a is there twice", two(2048, "a")),
      {{"Overlap", "/a and /b lie in the same bytes, expected arrays apart from each other"}, two(1088, "b")},
      {{"SamePlace", "/a and /b lie in the same bytes, expected arrays apart from each other"},
       two(1024, "b")},
      lie("NoType", "/a has no known type", type),
      lie("NoKind", "it has a part of no known kind", kind),
      lie("TextWithZeros", "a text has zeros in it", text(std::string("palpate\0model", 13))),
      lie("TextLongerThanTheAnswer", "it ends too early",
          ending(text("12345678"), number(~0ULL) + "12345678E")),
      lie("NumbersLongerThanTheAnswer", "it ends too early",
          [] {
            ModelAnswer answer;
            const double value = 1.0;
            answer.addNumbers("E", {&value, 1});
            return ending(answer.whole(), number(1ULL << 61U) + number(0) + "E");
          }()),
      lie("MorePartsThanAModelHas", "it has more than 256 parts",
          [] {
            ModelAnswer answer;
            for (int i = 0; i < 257; ++i) answer.addArray(std::to_string(i), {NumberType::kI8, {0}}, 0);
            return answer.whole();
          }()),
      {{"NothingInIt", "attribute format is missing"}, ModelAnswer().whole()},
      {{"FormatOfLines", "attribute format is \"a?b\", expected \"palpate-model\""}, text("a\nb")},
  };
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(All, AnswerIsNotBelieved, ::testing::ValuesIn(lies()), kCaseName);

TEST(ModelAnswer, PlacesThatTouchAreApart) {
  EXPECT_EQ(complaintOf(two(1152, "b")), "model.h5: attribute format is missing");
}

class LyingReader : public ::testing::Test {
 protected:
  LyingReader() : image_(written()), answer_(askReader(image_, "model.h5")) {}
  static SealedImage written() {
    const TemporaryFile file("model.h5");
    modelfile::writeModel(file.path(), goodData());
    return SealedImage(file.path());
  }

  const SealedImage image_;
  const std::string answer_;
};

TEST_F(LyingReader, OfAnAnswerThatIsCutAnywhereNothingIsTaken) {
  ASSERT_EQ(complaintOf(answer_, image_), "");
  for (std::size_t size = 0; size < answer_.size(); ++size)
    ASSERT_NE(complaintOf(answer_.substr(0, size), image_), "") << size;
}

/// Whatever it says, arrays are within the copy: their numbers are looked at, so that a sanitizer sees one that is not.
TEST_F(LyingReader, WhateverItSaysIsRefusedOrWithinTheCopy) {
  std::mt19937_64 random(22);
  constexpr std::array<std::uint64_t, 8> kOdd{0, 1, 64, 255, 1ULL << 31U, 1ULL << 61U, ~0ULL - 63, ~0ULL};
  int refused = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    std::string answer = answer_;
    const std::size_t at = random() % (answer.size() - sizeof(std::uint64_t));
    const std::uint64_t value = trial % 2 == 0 ? kOdd[random() % kOdd.size()] : random();
    std::memcpy(answer.data() + at, &value, trial % 4 < 2 ? sizeof value : 1);
    try {
      const ModelContents contents = readModel(AnsweredModel(image_, "model.h5", answer), "model.h5");
      checkContents(contents.attributes, contents.view, "model.h5");
    } catch (const LoadError& error) {
      ++refused;
      ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(refused, 10'000);
}

}  // namespace palpate::testing
