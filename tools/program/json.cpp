// SPDX-License-Identifier: Apache-2.0
#include "tools/program/json.h"

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

namespace palpate::program {
namespace {

using Text = nlohmann::ordered_json;

// nlohmann's value of ours; it writes the text.
Text toText(const Json& json, Keys keys) {
  if (json.isNull()) return nullptr;
  if (json.isBool()) return json.get<bool>();
  if (json.isUnsigned()) return json.get<std::uint64_t>();
  if (json.isWhole()) return json.get<std::int64_t>();
  if (json.isNumber()) return json.get<double>();
  if (json.isString()) return json.text();
  if (json.isArray()) {
    Text array = Text::array();
    for (const Json& entry : json) array.push_back(toText(entry, keys));
    return array;
  }
  std::vector<const Json::Member*> members;
  for (const Json::Member& member : json.members()) members.push_back(&member);
  if (keys == Keys::kSorted)
    std::sort(members.begin(), members.end(), [](const auto* a, const auto* b) { return a->key < b->key; });
  Text object = Text::object();
  for (const Json::Member* member : members)
    object.get_ref<Text::object_t&>().emplace_back(member->key, toText(member->value, keys));
  return object;
}

// Ours of nlohmann's, which has read the text. @throw JsonError where it is nested deeper than anything we read
Json fromText(const Text& text, int depth = 0) {
  if (depth > 100) throw JsonError("JSON is nested more than 100 deep");
  switch (text.type()) {
    case Text::value_t::boolean:
      return text.get<bool>();
    case Text::value_t::number_integer:
      return text.get<std::int64_t>();
    case Text::value_t::number_unsigned:
      return text.get<std::uint64_t>();
    case Text::value_t::number_float:
      return text.get<double>();
    case Text::value_t::string:
      return text.get_ref<const std::string&>();
    case Text::value_t::array: {
      Json array = Json::array();
      for (const Text& entry : text) array.push_back(fromText(entry, depth + 1));
      return array;
    }
    case Text::value_t::object: {
      Json object = Json::object();
      for (const auto& [key, value] : text.items()) object[key] = fromText(value, depth + 1);
      return object;
    }
    default:
      return nullptr;
  }
}

[[noreturn]] void refuse(const Json& json, const char* wanted) {
  throw JsonError("JSON is " + json.dump() + ", expected " + wanted);
}

}  // namespace

Json::Json() noexcept : value_(nullptr) {}
Json::Json(std::nullptr_t) noexcept : value_(nullptr) {}
Json::Json(const char* text) : value_(std::string(text)) {}
Json::Json(std::string_view text) : value_(std::string(text)) {}
Json::Json(std::string text) : value_(std::move(text)) {}
Json::Json(std::initializer_list<Member> members) : value_(Object(members)) {}
Json::Json(const Json&) = default;
Json::Json(Json&&) noexcept = default;
Json& Json::operator=(const Json&) = default;
Json& Json::operator=(Json&&) noexcept = default;
Json::~Json() = default;

Json Json::array() {
  Json json;
  json.value_ = Array{};
  return json;
}

Json Json::object() {
  Json json;
  json.value_ = Object{};
  return json;
}

std::optional<Json> Json::read(std::string_view text) {
  const Text parsed = Text::parse(text, nullptr, false);
  if (parsed.is_discarded()) return std::nullopt;
  try {
    return fromText(parsed);
  } catch (const JsonError&) {
    return std::nullopt;
  }
}

Json Json::parse(std::string_view text) {
  if (auto json = read(text)) return *std::move(json);
  throw JsonError("not JSON: " + std::string(text.substr(0, 200)));
}

bool Json::isNull() const noexcept {
  return std::holds_alternative<std::nullptr_t>(value_);
}

bool Json::isBool() const noexcept {
  return std::holds_alternative<bool>(value_);
}

bool Json::isNumber() const noexcept {
  return isWhole() || std::holds_alternative<double>(value_);
}

bool Json::isWhole() const noexcept {
  return std::holds_alternative<std::int64_t>(value_) || std::holds_alternative<std::uint64_t>(value_);
}

bool Json::isUnsigned() const noexcept {
  const std::int64_t* const number = std::get_if<std::int64_t>(&value_);
  return std::holds_alternative<std::uint64_t>(value_) || (number != nullptr && *number >= 0);
}

bool Json::isString() const noexcept {
  return std::holds_alternative<std::string>(value_);
}

bool Json::isArray() const noexcept {
  return std::holds_alternative<Array>(value_);
}

bool Json::isObject() const noexcept {
  return std::holds_alternative<Object>(value_);
}

const std::string& Json::text() const {
  if (!isString()) refuse(*this, "a text");
  return std::get<std::string>(value_);
}

Json::Number Json::number() const {
  if (const auto* whole = std::get_if<std::int64_t>(&value_)) return *whole;
  if (const auto* natural = std::get_if<std::uint64_t>(&value_)) return *natural;
  if (!isNumber()) refuse(*this, "a number");
  return std::get<double>(value_);
}

bool Json::truth() const {
  if (!isBool()) refuse(*this, "true or false");
  return std::get<bool>(value_);
}

std::size_t Json::size() const noexcept {
  if (const auto* array = std::get_if<Array>(&value_)) return array->size();
  if (const auto* object = std::get_if<Object>(&value_)) return object->size();
  return isNull() ? 0 : 1;
}

const Json::Array& Json::entries() const {
  if (!isArray()) refuse(*this, "an array");
  return std::get<Array>(value_);
}

const Json& Json::operator[](std::size_t index) const {
  const Array& array = entries();
  if (index >= array.size()) refuse(*this, "a longer array");
  return array[index];
}

void Json::push_back(Json entry) {
  if (isNull()) value_ = Array{};
  if (!isArray()) refuse(*this, "an array");
  std::get<Array>(value_).push_back(std::move(entry));
}

const Json::Object& Json::members() const {
  if (!isObject()) refuse(*this, "an object");
  return std::get<Object>(value_);
}

const Json* Json::find(std::string_view key) const noexcept {
  const auto* object = std::get_if<Object>(&value_);
  if (object == nullptr) return nullptr;
  const auto found =
      std::find_if(object->begin(), object->end(), [&](const Member& member) { return member.key == key; });
  return found == object->end() ? nullptr : &found->value;
}

const Json& Json::at(std::string_view key) const {
  if (const Json* member = find(key)) return *member;
  throw JsonError("JSON has no key '" + std::string(key) + "'");
}

Json& Json::operator[](std::string_view key) {
  if (isNull()) value_ = Object{};
  if (const Json* member = find(key)) return const_cast<Json&>(*member);
  if (!isObject()) refuse(*this, "an object");
  return std::get<Object>(value_).emplace_back(Member{std::string(key), Json()}).value;
}

std::string Json::dump(int indent, Keys keys) const {
  return toText(*this, keys).dump(indent, ' ', false, Text::error_handler_t::replace);
}

bool operator==(const Json& a, const Json& b) {
  if (a.isNumber() && b.isNumber())
    return a.isWhole() && b.isWhole() ? a.dump() == b.dump() : a.get<double>() == b.get<double>();
  if (a.isArray() && b.isArray()) return a.entries() == b.entries();
  if (!a.isObject() || !b.isObject()) return a.value_.index() == b.value_.index() && a.dump() == b.dump();
  const auto in_b = [&](const Json::Member& member) {
    const Json* const other = b.find(member.key);
    return other != nullptr && *other == member.value;
  };
  return a.size() == b.size() && std::all_of(a.members().begin(), a.members().end(), in_b);
}

std::ostream& operator<<(std::ostream& out, const Json& json) {
  return out << json.dump(-1, Keys::kAsWritten);
}

void printJson(const Json& object) {
  std::cout << object.dump() << std::endl;
}

}  // namespace palpate::program
