// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/data/datasets.h"
#include "core/data/hdf5_handle.h"
#include "core/data/sealed_image.h"

namespace palpate {

/// Keeps HDF5 from printing its errors, which leave here as LoadError, and restores what was set before.
class Hdf5Silence {
 public:
  Hdf5Silence();
  Hdf5Silence(const Hdf5Silence&) = delete;
  Hdf5Silence& operator=(const Hdf5Silence&) = delete;
  ~Hdf5Silence();

 private:
  int (*function_)(std::int64_t, void*){nullptr};
  void* data_{nullptr};
};

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

/// Attributes and arrays of a file that may be hostile: type, shape, layout, filters and place of each are
/// checked, the numbers are not. Every refusal is a LoadError: file, dataset, found, expected. Does not include
/// HDF5 itself.
class Hdf5Reader {
 public:
  /// @param image  outlives the reader and all spans  @param name  how the file is called in messages
  Hdf5Reader(const SealedImage& image, std::string name);

  [[noreturn]] void fail(const std::string& what) const;
  [[nodiscard]] bool hasAttribute(const char* attribute) const;
  [[nodiscard]] bool hasDataset(const std::string& path) const;
  [[nodiscard]] double number(const char* attribute) const;
  /// @param[out] values  as many as the attribute has to have
  void numbers(const char* attribute, std::span<double> values) const;
  [[nodiscard]] int integer(const char* attribute) const;
  [[nodiscard]] std::string text(const char* attribute) const;
  /// A dataset where it lies in the image. Unknown lengths are filled in.
  template <typename T>
  [[nodiscard]] std::span<const T> dataset(const Dataset<T>& what, Lengths& lengths) const;

 private:
  [[nodiscard]] Hdf5Handle openImage() const;
  [[nodiscard]] Hdf5Handle openAttribute(const char* attribute, int values) const;
  [[nodiscard]] Hdf5Handle openDataset(const std::string& path) const;
  void checkLink(const std::string& path) const;
  void checkShape(const std::string& path, std::int64_t dataset, std::span<Length* const> wanted) const;
  void checkType(const std::string& path, std::int64_t dataset, std::int64_t wanted) const;
  void checkLayout(const std::string& path, std::int64_t dataset) const;
  [[nodiscard]] const std::byte* place(const std::string& path, std::int64_t dataset,
                                       std::uint64_t bytes) const;

  Hdf5Silence silence_;  // first: silences HDF5 from opening to closing
  const SealedImage& image_;
  std::string name_;
  Hdf5Handle file_;
};

}  // namespace palpate
