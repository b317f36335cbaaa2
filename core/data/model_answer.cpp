// SPDX-License-Identifier: Apache-2.0
#include "core/data/model_answer.h"

#include <algorithm>
#include <cstring>
#include <tuple>
#include <type_traits>
#include <utility>

#include "core/data/available_memory.h"
#include "core/data/datasets.h"

namespace palpate {

namespace {

constexpr std::string_view kBegin = "palpate-read-model 1\n";
constexpr char kNumbers = 'N', kText = 'T', kArray = 'A', kRefusal = 'R', kEnd = 'E';
constexpr std::size_t kMostRank = std::tuple_size_v<decltype(Dataset<double>::shape)>;
constexpr std::size_t kMostOfARefusal = 1000;  // bytes
constexpr int kMostParts = 256;                // a model has fewer names

template <class T>
void put(std::string& to, T value) {
  static_assert(std::is_trivially_copyable_v<T>);
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void putText(std::string& to, std::string_view text) {
  put(to, static_cast<std::uint64_t>(text.size()));
  to.append(text);
}

void putName(std::string& to, char kind, std::string_view name) {
  put(to, kind);
  putText(to, name);
}

}  // namespace

void ModelAnswer::addNumbers(std::string_view attribute, std::span<const double> values) {
  putName(records_, kNumbers, attribute);
  put(records_, static_cast<std::uint64_t>(values.size()));
  for (const double value : values) put(records_, value);
}

void ModelAnswer::addText(std::string_view attribute, std::string_view text) {
  putName(records_, kText, attribute);
  putText(records_, text);
}

void ModelAnswer::addArray(std::string_view path, const ArrayShape& shape, std::uint64_t offset) {
  putName(records_, kArray, path);
  put(records_, static_cast<std::uint8_t>(shape.type));
  put(records_, static_cast<std::uint64_t>(shape.lengths.size()));
  for (const std::uint64_t length : shape.lengths) put(records_, length);
  put(records_, offset);
}

std::string ModelAnswer::whole() const {
  return std::string(kBegin) + records_ + kEnd;
}

std::string ModelAnswer::refusal(std::string_view why) {
  std::string answer(kBegin);
  putName(answer, kRefusal, why);
  return answer + kEnd;
}

/// What is left of an answer. Nothing is taken that it does not have.
class AnsweredModel::Records {
 public:
  Records(std::string_view left, const AnsweredModel& model) : left_(left), model_(model) {}

  template <class T>
  [[nodiscard]] T number() {
    const std::string_view bytes = take(sizeof(T));
    T value{};
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  /// As many numbers as the next number says. @param most  of them
  template <class T>
  [[nodiscard]] std::vector<T> numbers(std::size_t most) {
    const auto count = number<std::uint64_t>();
    if (count > most || count > left_.size() / sizeof(T)) cutOff();
    std::vector<T> values(static_cast<std::size_t>(count));
    for (T& value : values) value = number<T>();
    return values;
  }
  [[nodiscard]] std::string text() {
    const auto size = number<std::uint64_t>();
    std::string text(take(size));
    if (text.find('\0') != std::string::npos) model_.disbelieve("a text has zeros in it");
    return text;
  }
  [[nodiscard]] bool none() const { return left_.empty(); }

 private:
  [[noreturn]] void cutOff() const { model_.disbelieve("it ends too early"); }
  [[nodiscard]] std::string_view take(std::uint64_t size) {
    if (size > left_.size()) cutOff();
    const std::string_view taken = left_.substr(0, static_cast<std::size_t>(size));
    left_.remove_prefix(taken.size());
    return taken;
  }

  std::string_view left_;
  const AnsweredModel& model_;
};

AnsweredModel::AnsweredModel(const SealedImage& image, const std::string& name, std::string_view answer)
    : ArrayReader(name), image_(image) {
  if (!answer.starts_with(kBegin)) disbelieve("it is not that of this version of palpate-read-model");
  Records records(answer.substr(kBegin.size()), *this);
  int parts = 0;
  for (char kind = records.number<char>(); kind != kEnd; kind = records.number<char>()) {
    if (++parts > kMostParts) disbelieve("it has more than " + std::to_string(kMostParts) + " parts");
    const std::string what = records.text();
    if (kind == kRefusal) fail(what.substr(0, kMostOfARefusal));
    if (hasAttribute(what.c_str()) || hasDataset(what)) disbelieve(what + " is there twice");
    if (kind == kArray)
      takeArray(what, records);
    else
      takeAttribute(kind, what, records);
  }
  if (!records.none()) disbelieve("it goes on behind its end");
  requireApart();
}

void AnsweredModel::takeAttribute(char kind, const std::string& name, Records& records) {
  constexpr std::size_t kMostNumbers = 16;
  if (kind == kText)
    addAttribute(name, records.text());
  else if (kind == kNumbers)
    addAttribute(name, records.numbers<double>(kMostNumbers));
  else
    disbelieve("it has a part of no known kind");
}

void AnsweredModel::takeArray(const std::string& path, Records& records) {
  const auto type = records.number<std::uint8_t>();
  if (type > static_cast<std::uint8_t>(NumberType::kI8)) disbelieve("/" + path + " has no known type");
  ArrayShape shape{static_cast<NumberType>(type), records.numbers<std::uint64_t>(kMostRank)};
  const auto offset = records.number<std::uint64_t>();
  const std::uint64_t size = image_.bytes().size();
  std::uint64_t bytes = bytesOf(shape.type);
  for (const std::uint64_t length : shape.lengths)
    if (__builtin_mul_overflow(bytes, length, &bytes)) disbelieve("/" + path + " has no size");
  if (offset > size || bytes > size - offset)
    disbelieve("/" + path + " lies at bytes " + std::to_string(offset) + " + " + std::to_string(bytes) +
               ", expected within the file's " + std::to_string(size));
  if (offset % kArrayAlignment != 0)
    disbelieve("/" + path + " begins at byte " + std::to_string(offset) + ", expected a multiple of " +
               std::to_string(kArrayAlignment));
  placeArray(path, std::move(shape), image_.bytes().subspan(offset, bytes));
  if (bytes > 0) places_.push_back({offset, offset + bytes, path});
}

/// A file holds each array by itself; two in one place are made to have the checks of one hold for the other's numbers.
void AnsweredModel::requireApart() {
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
    return std::tie(a.begin, a.path) < std::tie(b.begin, b.path);
  });
  const auto overlap = std::adjacent_find(places_.begin(), places_.end(),
                                          [](const Place& a, const Place& b) { return b.begin < a.end; });
  if (overlap != places_.end())
    fail("/" + overlap->path + " and /" + std::next(overlap)->path +
         " lie in the same bytes, expected arrays apart from each other");
}

void AnsweredModel::requireRoom(std::uint64_t bytes) const {
  requireMemory(name(), "a copy of what it has in fewer bytes", bytes);
}

void AnsweredModel::disbelieve(const std::string& what) const {
  fail("the answer of the process that parses it is not to be believed: " + what);
}

}  // namespace palpate
