// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

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
enum class NumberType { kF64, kF32, kI16, kI32, kI64, kU8, kRegionName };

/// Attributes and arrays of a model, wherever they come from: a file by HDF5 (Hdf5Reader), or bytes that a page has read
/// (ArrayReader). Types, shapes and places are checked, the numbers are not. Every refusal is a LoadError: file, dataset,
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
  /// A dataset where it lies in memory. Unknown lengths are filled in.
  template <typename T>
  [[nodiscard]] std::span<const T> dataset(const Dataset<T>& what, Lengths& lengths) const;

 protected:
  /// @param name  how the file is called in messages
  explicit ModelSource(std::string name) : name_(std::move(name)) {}

 private:
  /// @throw LoadError  there is no such array, or it has another type
  [[nodiscard]] virtual std::vector<std::uint64_t> shape(const std::string& path, NumberType type) const = 0;
  /// Where the numbers of an array are that has this many bytes; null without any. @throw LoadError  it does not lie there whole
  [[nodiscard]] virtual const std::byte* place(const std::string& path, std::uint64_t bytes) const = 0;
  /// Of everything.
  [[nodiscard]] virtual std::uint64_t bytes() const = 0;
  [[nodiscard]] std::vector<Length*> shapeOf(const std::string& path, NumberType type,
                                             std::span<const char* const> symbols, Lengths& lengths) const;

  std::string name_;
};

}  // namespace palpate
