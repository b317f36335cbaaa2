// SPDX-License-Identifier: Apache-2.0
#include "changed_model.h"

#include <array>
#include <iterator>
#include <utility>
#include <vector>

namespace palpate::fuzz {

namespace {

constexpr std::size_t kMostBytes = 1 << 16;  // of an array

// One of those that there are, or, of a good model, none.
template <class Map>
auto chosen(Map& map, Source& source) {
  auto at = map.begin();
  if (!map.empty()) std::advance(at, source.get<std::uint8_t>() % map.size());
  return at;
}

void overwrite(Source& source, GoodModel& model) {
  const auto array = chosen(model.arrays, source);
  const auto at = source.get<std::uint16_t>();
  const Bytes with = source.take(source.get<std::uint8_t>() % 64 + 1U);
  if (array == model.arrays.end()) return;
  for (std::size_t i = 0; i < with.size() && !array->second.bytes.empty(); ++i)
    array->second.bytes[(at + i) % array->second.bytes.size()] = with[i];
}

// Another type and shape; the bytes that belong to it, or other ones.
void reshape(Source& source, GoodModel& model) {
  const auto array = chosen(model.arrays, source);
  GoodModel::Array to;
  to.type = static_cast<NumberType>(source.get<std::uint8_t>() % 8);
  const auto form = source.get<std::uint8_t>();
  std::uint64_t numbers = 1;
  for (int i = 0; i < form % 5; ++i) {
    const auto length = source.get<std::uint8_t>();
    to.shape.push_back(length == 255 ? source.get<std::uint64_t>() : length);
    numbers *= to.shape.back();
  }
  constexpr std::array<std::size_t, 8> kBytes{8, 4, 2, 4, 8, 1, sizeof(RegionName), 1};
  const std::size_t fits = numbers * kBytes[static_cast<std::size_t>(to.type)];
  const Bytes with = source.take(source.get<std::uint8_t>());
  to.bytes.resize((form & 128) != 0 || fits > kMostBytes ? with.size() : fits);
  for (std::size_t i = 0; i < to.bytes.size() && !with.empty(); ++i) to.bytes[i] = with[i % with.size()];
  if (array != model.arrays.end()) array->second = std::move(to);
}

void say(Source& source, GoodModel& model) {
  const auto attribute = chosen(model.attributes, source);
  const auto form = source.get<std::uint8_t>();
  ArrayReader::Attribute value;
  if (form % 2 == 0) {
    value = source.text(source.get<std::uint8_t>());
  } else {
    std::vector<double> numbers(form / 2 % 5);
    for (double& number : numbers)
      number = (form & 128) != 0 ? source.get<std::int8_t>() : source.get<double>();
    value = std::move(numbers);
  }
  if (attribute != model.attributes.end()) attribute->second = std::move(value);
}

template <class Map>
void remove(Source& source, Map& map) {
  if (const auto at = chosen(map, source); at != map.end()) map.erase(at);
}

}  // namespace

GoodModel changedModel(Bytes input) {
  Source source(input);
  static const std::array<GoodModel, kGoodModels> kModels{goodModel(0), goodModel(1), goodModel(2),
                                                          goodModel(3)};
  GoodModel model = kModels[source.get<std::uint8_t>() % kGoodModels];
  while (!source.empty()) {
    switch (source.get<std::uint8_t>() % 6) {
      case 0:
      case 1:
        overwrite(source, model);
        break;
      case 2:
        reshape(source, model);
        break;
      case 3:
        say(source, model);
        break;
      case 4:
        remove(source, model.arrays);
        break;
      default:
        remove(source, model.attributes);
    }
  }
  return model;
}

void fill(ArrayReader& reader, const GoodModel& model) {
  for (const auto& [name, value] : model.attributes) reader.addAttribute(name, value);
  for (const auto& [path, array] : model.arrays) {
    std::byte* const room = reader.addArray(path, array.type, array.shape, array.bytes.size());
    if (!array.bytes.empty()) std::memcpy(room, array.bytes.data(), array.bytes.size());
  }
}

}  // namespace palpate::fuzz
