// SPDX-License-Identifier: Apache-2.0
#include "core/data/array_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate {

std::byte* ArrayReader::addArray(const std::string& path, NumberType type, std::vector<std::uint64_t> shape,
                                 std::size_t bytes) {
  Array& array = (*arrays_)[path];
  bytes_ += bytes - array.bytes;
  // Not cleared, as it is filled in. emscripten 3.1 has no make_unique_for_overwrite.
  array = {type, std::move(shape), std::unique_ptr<double[]>(new double[bytes / sizeof(double) + 1]), nullptr,
           bytes};
  auto* const first = static_cast<std::byte*>(static_cast<void*>(array.room.get()));
  array.first = first;
  return first;
}

void ArrayReader::placeArray(const std::string& path, ArrayShape shape, std::span<const std::byte> bytes) {
  (*arrays_)[path] = {shape.type, std::move(shape.lengths), {}, bytes.data(), bytes.size()};
  bytes_ += bytes.size();
}

bool ArrayReader::hasAttribute(const char* attribute) const {
  return attributes_.count(attribute) > 0;
}

bool ArrayReader::hasDataset(const std::string& path) const {
  return arrays_->count(path) > 0;
}

template <typename T>
const T& ArrayReader::attribute(const char* name, const char* expected) const {
  const auto found = attributes_.find(name);
  if (found == attributes_.end()) fail(std::string("attribute ") + name + " is missing");
  const T* const value = std::get_if<T>(&found->second);
  if (value == nullptr) fail(std::string("attribute ") + name + " is not " + expected);
  return *value;
}

void ArrayReader::numbers(const char* attribute, std::span<double> values) const {
  const std::vector<double>& found = this->attribute<std::vector<double>>(attribute, "a number");
  if (found.size() != values.size())
    fail(std::string("attribute ") + attribute + " is " + std::to_string(found.size()) +
         " values, expected " + std::to_string(values.size()));
  std::copy(found.begin(), found.end(), values.begin());
}

int ArrayReader::integer(const char* attribute) const {
  const std::vector<double>& found = this->attribute<std::vector<double>>(attribute, "an integer");
  const auto fits = [](double x) {
    return x == std::trunc(x) && std::abs(x) <= std::numeric_limits<int>::max();
  };
  if (found.size() != 1 || !fits(found.front()))
    fail(std::string("attribute ") + attribute + " is not an integer");
  return static_cast<int>(found.front());
}

std::string ArrayReader::text(const char* attribute) const {
  return this->attribute<std::string>(attribute, "readable text");
}

const ArrayReader::Array& ArrayReader::array(const std::string& path) const {
  const auto found = arrays_->find(path);
  if (found == arrays_->end()) fail("/" + path + " is missing");
  return found->second;
}

ArrayShape ArrayReader::shape(const std::string& path, NumberType wanted) const {
  const Array& found = array(path);
  if (found.type != wanted && !isNarrower(found.type, wanted))
    fail("/" + path + " has numbers of another type than expected");
  return {found.type, found.shape};
}

const std::byte* ArrayReader::place(const std::string& path, std::uint64_t bytes) const {
  const Array& found = array(path);
  if (found.bytes != bytes)
    fail("/" + path + " has " + std::to_string(found.bytes) + " bytes, expected " + std::to_string(bytes));
  return found.first;
}

}  // namespace palpate
