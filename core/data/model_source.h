// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/whole_numbers.h"
#include "core/data/datasets.h"

namespace palpate {

/// One length of a shape: a number, or a symbol that the first dataset with it defines.
struct Length {
  static constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();
  std::string symbol;
  std::uint64_t value{kUnknown};
  Length(std::uint64_t number) : symbol(std::to_string(number)), value(number) {}
  explicit Length(const char* letter) : symbol(letter) {}
  [[nodiscard]] std::string text() const {
    return value == kUnknown || symbol == std::to_string(value) ? symbol
                                                                : symbol + " = " + std::to_string(value);
  }
};

/// The lengths of a file by their symbols: those of shapes in datasets.h.
class Lengths {
 public:
  /// Of "3" the number; of a symbol what was defined before, or unknown.
  [[nodiscard]] Length& operator[](const char* symbol);
  void define(const char* symbol, std::uint64_t value);
  [[nodiscard]] std::uint64_t value(const char* symbol) { return (*this)[symbol].value; }

 private:
  std::map<std::string, Length> lengths_;
};

/// What numbers of an array are.
enum class NumberType { kF64, kF32, kI16, kI32, kI64, kU8, kRegionName, kI8 };

/// Of one number.
[[nodiscard]] std::size_t bytesOf(NumberType type);

/// Whether numbers of one type are all numbers of the other, which has more bytes: an array may be stored in fewer.
[[nodiscard]] bool isNarrower(NumberType stored, NumberType wanted) noexcept;

/// What is known of an array before its numbers are looked at.
struct ArrayShape {
  NumberType type{};  ///< as stored
  std::vector<std::uint64_t> lengths;
};

/// Attributes and arrays of a model, wherever they come from: a file that HDF5 parses (Hdf5Reader, in a process of its own), what
/// that process says of it (AnsweredModel), or bytes that a page has read (ArrayReader). Types, shapes and places are checked, the numbers are not. Every refusal is a LoadError: file, dataset,
/// found, expected.
class ModelSource {
 public:
  ModelSource(const ModelSource&) = delete;
  ModelSource& operator=(const ModelSource&) = delete;
  virtual ~ModelSource() = default;

  [[noreturn]] void fail(const std::string& what) const;
  [[nodiscard]] virtual bool hasAttribute(const char* attribute) const = 0;
  [[nodiscard]] virtual bool hasDataset(const std::string& path) const = 0;
  /// @param[out] values  as many as the attribute has to have
  virtual void numbers(const char* attribute, std::span<double> values) const = 0;
  [[nodiscard]] double number(const char* attribute) const;
  [[nodiscard]] virtual int integer(const char* attribute) const = 0;
  [[nodiscard]] virtual std::string text(const char* attribute) const = 0;
  /// A dataset where it lies in memory, or a copy where it is stored in fewer bytes. Unknown lengths are filled in.
  template <typename T>
  [[nodiscard]] std::span<const T> dataset(const Dataset<T>& what, Lengths& lengths) const;
  /// The same of numbers that are used as they are stored, in one byte or two.
  [[nodiscard]] WholeNumbers wholeNumbers(const Dataset<std::int16_t>& what, Lengths& lengths) const;
  /// What keeps the copies; they live as long as any copy of it.
  [[nodiscard]] std::shared_ptr<const void> copies() const { return copies_; }

 protected:
  /// @param name  how the file is called in messages
  explicit ModelSource(std::string name) : name_(std::move(name)) {}
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  /// @throw LoadError  there is no such array, or it has another type, and not a narrower one
  [[nodiscard]] virtual ArrayShape shape(const std::string& path, NumberType wanted) const = 0;
  /// Where the numbers of an array are that has this many bytes; null without any, or where nobody looks at them. @throw LoadError  it does not lie there whole
  [[nodiscard]] virtual const std::byte* place(const std::string& path, std::uint64_t bytes) const = 0;
  /// Of everything.
  [[nodiscard]] virtual std::uint64_t bytes() const = 0;
  /// Before so much memory is taken for copies. @throw LoadError  there is not enough
  virtual void requireRoom(std::uint64_t bytes) const { (void)bytes; }
  [[nodiscard]] std::vector<Length*> checked(const std::string& path, const std::vector<std::uint64_t>& found,
                                             std::span<const char* const> symbols, Lengths& lengths) const;
  /// The numbers of an array, as they are stored.
  struct Stored {
    NumberType type{};
    const std::byte* first{nullptr};  // null: there are none, or nobody looks at them
    std::size_t count{0};
    template <typename T>
    [[nodiscard]] std::span<const T> as() const {
      return {static_cast<const T*>(static_cast<const void*>(first)), first == nullptr ? 0 : count};
    }
  };
  [[nodiscard]] Stored stored(const std::string& path, NumberType wanted,
                              std::span<const char* const> symbols, Lengths& lengths) const;
  template <typename T>
  [[nodiscard]] std::span<const T> widened(const Stored& stored) const;

  std::string name_;
  using Copies = std::vector<std::unique_ptr<double[]>>;  // aligned for any number
  std::shared_ptr<Copies> copies_{std::make_shared<Copies>()};
};

}  // namespace palpate
