// SPDX-License-Identifier: Apache-2.0
#include "core/data/model_source.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <type_traits>

#include "core/data/load_error.h"

namespace palpate {

namespace {

constexpr std::uint64_t kMaxLength =
    std::numeric_limits<std::int32_t>::max() / 4;  // int arithmetic on 3 n is safe

template <typename T>
constexpr NumberType typeOf() {
  if constexpr (std::is_same_v<T, double>) return NumberType::kF64;
  if constexpr (std::is_same_v<T, float>) return NumberType::kF32;
  if constexpr (std::is_same_v<T, std::int16_t>) return NumberType::kI16;
  if constexpr (std::is_same_v<T, std::int32_t>) return NumberType::kI32;
  if constexpr (std::is_same_v<T, std::int64_t>) return NumberType::kI64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return NumberType::kU8;
  if constexpr (std::is_same_v<T, RegionName>) return NumberType::kRegionName;
}

/// Calls work(a number of the type), of those that are ever narrower than others.
template <class Work>
void asNumber(NumberType type, const Work& work) {
  if (type == NumberType::kI8) return work(std::int8_t{});
  if (type == NumberType::kI16) return work(std::int16_t{});
  if (type == NumberType::kI32) return work(std::int32_t{});
  if (type == NumberType::kF32) return work(float{});
}

}  // namespace

std::size_t bytesOf(NumberType type) {
  constexpr std::array<std::size_t, 8> kBytes{8, 4, 2, 4, 8, 1, sizeof(RegionName), 1};
  return kBytes.at(static_cast<std::size_t>(type));
}

bool isNarrower(NumberType stored, NumberType wanted) noexcept {
  if (wanted == NumberType::kF64) return stored == NumberType::kF32;
  constexpr std::array kSigned{NumberType::kI8, NumberType::kI16, NumberType::kI32, NumberType::kI64};
  const auto* const to = std::find(kSigned.begin(), kSigned.end(), wanted);
  return to != kSigned.end() && std::find(kSigned.begin(), to, stored) != to;
}

void ModelSource::fail(const std::string& what) const {
  throw LoadError(name_ + ": " + printable(what));
}

double ModelSource::number(const char* attribute) const {
  double value = 0.0;
  numbers(attribute, {&value, 1});
  return value;
}

std::vector<Length*> ModelSource::checked(const std::string& path, const std::vector<std::uint64_t>& found,
                                          std::span<const char* const> symbols, Lengths& lengths) const {
  std::vector<Length*> wanted;
  for (const char* symbol : symbols)
    if (symbol != nullptr) wanted.push_back(&lengths[symbol]);
  bool good = found.size() == wanted.size();
  for (std::size_t i = 0; good && i < wanted.size(); ++i) {
    if (wanted[i]->value == Length::kUnknown && found[i] <= kMaxLength) wanted[i]->value = found[i];
    good = wanted[i]->value == found[i];
  }
  if (good) return wanted;
  std::string is, should;
  for (const std::uint64_t length : found) is += (is.empty() ? "" : " x ") + std::to_string(length);
  for (const Length* length : wanted) should += (should.empty() ? "" : " x ") + length->text();
  fail("/" + path + " has shape " + (found.empty() ? "of no array" : is) + ", expected " + should);
}

ModelSource::Stored ModelSource::stored(const std::string& path, NumberType wanted,
                                        std::span<const char* const> symbols, Lengths& lengths) const {
  const ArrayShape found = shape(path, wanted);
  const std::uint64_t limit = bytes() / bytesOf(found.type);
  std::uint64_t count = 1;
  for (const Length* length : checked(path, found.lengths, symbols, lengths)) {
    if (length->value != 0 && count > limit / length->value)
      fail("/" + path + " has more numbers than the file's " + std::to_string(bytes()) + " bytes can hold");
    count *= length->value;
  }
  const std::byte* const first = place(path, count * bytesOf(found.type));
  return {found.type, count == 0 ? nullptr : first, static_cast<std::size_t>(count)};
}

template <typename T>
std::span<const T> ModelSource::dataset(const Dataset<T>& what, Lengths& lengths) const {
  const Stored found = stored(what.path, typeOf<T>(), what.shape, lengths);
  return found.first == nullptr || found.type == typeOf<T>() ? found.as<T>() : widened<T>(found);
}

WholeNumbers ModelSource::wholeNumbers(const Dataset<std::int16_t>& what, Lengths& lengths) const {
  const Stored found = stored(what.path, NumberType::kI16, what.shape, lengths);
  if (found.type == NumberType::kI8) return found.as<std::int8_t>();
  return found.as<std::int16_t>();
}

/// A copy in as many bytes as tables want.
template <typename T>
std::span<const T> ModelSource::widened(const Stored& stored) const {
  requireRoom(stored.count * sizeof(T));
  // Not cleared (array_reader.cpp).
  copies_->push_back(std::unique_ptr<double[]>(new double[stored.count * sizeof(T) / sizeof(double) + 1]));
  T* const to = static_cast<T*>(static_cast<void*>(copies_->back().get()));
  if constexpr (std::is_arithmetic_v<T>)
    asNumber(stored.type, [&]<class Number>(Number) {
      const std::span<const Number> from = stored.as<Number>();
      std::transform(from.begin(), from.end(), to, [](Number number) { return static_cast<T>(number); });
    });
  return {to, stored.count};
}

template std::span<const double> ModelSource::dataset(const Dataset<double>&, Lengths&) const;
template std::span<const float> ModelSource::dataset(const Dataset<float>&, Lengths&) const;
template std::span<const std::int32_t> ModelSource::dataset(const Dataset<std::int32_t>&, Lengths&) const;
template std::span<const std::int64_t> ModelSource::dataset(const Dataset<std::int64_t>&, Lengths&) const;
template std::span<const std::uint8_t> ModelSource::dataset(const Dataset<std::uint8_t>&, Lengths&) const;
template std::span<const RegionName> ModelSource::dataset(const Dataset<RegionName>&, Lengths&) const;

Length& Lengths::operator[](const char* symbol) {
  const bool number = std::string_view(symbol).find_first_not_of("0123456789") == std::string_view::npos;
  const auto [entry, added] =
      lengths_.try_emplace(symbol, number ? Length(std::stoull(symbol)) : Length(symbol));
  return entry->second;
}

void Lengths::define(const char* symbol, std::uint64_t value) {
  lengths_.insert_or_assign(symbol, Length(value));
}

}  // namespace palpate
