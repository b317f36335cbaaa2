// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace palpate::program {

/// Text that is not JSON, or a value of another kind than the one asked for.
class JsonError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Order of an object's keys in a text.
enum class Keys { kSorted, kAsWritten };

class Json;

template <class T>
concept JsonNumber = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

/// A list that becomes an array: std::vector, std::array, a fixed-size Eigen vector.
template <class T>
concept JsonList = !std::same_as<T, Json> && !std::convertible_to<const T&, std::string> &&
                   !std::convertible_to<const T&, std::string_view> && requires(const T& list) {
  list.begin();
  list.end();
};

/// A JSON value: null, truth, number, text, array or object. An object is written {{"key", value}, ...}.
/// Threads: as a std::vector. Real-time: no.
class Json {
 public:
  struct Member;
  using Array = std::vector<Json>;
  using Object = std::vector<Member>;  ///< in the order of writing, each key once

  Json() noexcept;
  Json(std::nullptr_t) noexcept;
  Json(const char* text);
  Json(std::string_view text);
  Json(std::string text);
  Json(std::initializer_list<Member> members);
  Json(std::same_as<bool> auto truth) : value_(truth) {}
  Json(JsonNumber auto number) : value_(widened(number)) {}
  template <JsonList List>
  Json(const List& list) : Json(array()) {
    for (const auto& entry : list) push_back(Json(entry));
  }
  Json(const Json&);
  Json(Json&&) noexcept;
  Json& operator=(const Json&);
  Json& operator=(Json&&) noexcept;
  ~Json();

  [[nodiscard]] static Json array();
  [[nodiscard]] static Json object();
  /// @return nothing when `text` is no JSON, or nested more than 100 deep
  [[nodiscard]] static std::optional<Json> read(std::string_view text);
  /// @throw JsonError when `text` is no JSON, or nested more than 100 deep
  [[nodiscard]] static Json parse(std::string_view text);

  [[nodiscard]] bool isNull() const noexcept;
  [[nodiscard]] bool isBool() const noexcept;
  [[nodiscard]] bool isNumber() const noexcept;
  [[nodiscard]] bool isWhole() const noexcept;     ///< a number read or written without fraction or exponent
  [[nodiscard]] bool isUnsigned() const noexcept;  ///< whole, and not negative
  [[nodiscard]] bool isString() const noexcept;
  [[nodiscard]] bool isArray() const noexcept;
  [[nodiscard]] bool isObject() const noexcept;

  /// The value as a number (cast as C++ casts), a bool or a std::string. @throw JsonError when it is of another kind
  template <class T>
  [[nodiscard]] T get() const {
    if constexpr (std::is_same_v<T, std::string>) {
      return text();
    } else if constexpr (std::is_same_v<T, bool>) {
      return truth();
    } else {
      return std::visit([](auto number) { return static_cast<T>(number); }, number());
    }
  }
  /// @throw JsonError when it is no text
  [[nodiscard]] const std::string& text() const;

  /// Entries of an array or members of an object; 0 for null, 1 for all else.
  [[nodiscard]] std::size_t size() const noexcept;
  [[nodiscard]] bool empty() const noexcept { return size() == 0; }

  /// @throw JsonError when this is no array
  [[nodiscard]] const Array& entries() const;
  [[nodiscard]] Array::const_iterator begin() const { return entries().begin(); }
  [[nodiscard]] Array::const_iterator end() const { return entries().end(); }
  /// @throw JsonError when this is no array, or too short
  [[nodiscard]] const Json& operator[](std::size_t index) const;
  [[nodiscard]] const Json& front() const { return (*this)[0]; }
  [[nodiscard]] const Json& back() const { return (*this)[size() - 1]; }
  /// Null becomes an array. @throw JsonError when this is anything else
  void push_back(Json entry);

  /// @throw JsonError when this is no object
  [[nodiscard]] const Object& members() const;
  /// @return null when this is no object or has no such key
  [[nodiscard]] const Json* find(std::string_view key) const noexcept;
  [[nodiscard]] bool contains(std::string_view key) const noexcept { return find(key) != nullptr; }
  /// @throw JsonError naming the key that is missing
  [[nodiscard]] const Json& at(std::string_view key) const;
  [[nodiscard]] const Json& operator[](std::string_view key) const { return at(key); }
  /// The member of that key, made where it is missing; null becomes an object. @throw JsonError
  [[nodiscard]] Json& operator[](std::string_view key);

  /// The text. Numbers that are not finite become null, bytes that are not UTF-8 the replacement character.
  /// @param[in] indent  spaces a level; negative: all in one line
  [[nodiscard]] std::string dump(int indent = -1, Keys keys = Keys::kSorted) const;

  friend bool operator==(const Json& a, const Json& b);
  friend std::ostream& operator<<(std::ostream& out, const Json& json);

 private:
  using Number = std::variant<std::int64_t, std::uint64_t, double>;
  using Value =
      std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Array, Object>;

  template <class T>
  [[nodiscard]] static auto widened(T number) noexcept {
    if constexpr (std::is_floating_point_v<T>)
      return static_cast<double>(number);
    else if constexpr (std::is_signed_v<T>)
      return static_cast<std::int64_t>(number);
    else
      return static_cast<std::uint64_t>(number);
  }
  [[nodiscard]] Number number() const;
  [[nodiscard]] bool truth() const;

  Value value_;
};

struct Json::Member {
  std::string key;
  Json value;
};

/// Prints one object in one line on standard output.
void printJson(const Json& object);

}  // namespace palpate::program
