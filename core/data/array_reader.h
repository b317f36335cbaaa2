// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/data/model_source.h"

namespace palpate {

/// A model that somebody else has read, array by array: a page, by a library of its own. Attributes are texts or numbers.
class ArrayReader : public ModelSource {
 public:
  using Attribute = std::variant<std::string, std::vector<double>>;

  /// @param name  how the model is called in messages
  explicit ArrayReader(std::string name) : ModelSource(std::move(name)) {}

  void addAttribute(const std::string& name, Attribute value) { attributes_[name] = std::move(value); }
  /// Room for an array's numbers, to be filled in; never null. @param path  "contact/force"  @param bytes  its size
  [[nodiscard]] std::byte* addArray(const std::string& path, NumberType type,
                                    std::vector<std::uint64_t> shape, std::size_t bytes);
  /// What keeps the arrays; they live as long as any copy of it.
  [[nodiscard]] std::shared_ptr<const void> memory() const { return arrays_; }

  [[nodiscard]] bool hasAttribute(const char* attribute) const override;
  [[nodiscard]] bool hasDataset(const std::string& path) const override;
  void numbers(const char* attribute, std::span<double> values) const override;
  [[nodiscard]] int integer(const char* attribute) const override;
  [[nodiscard]] std::string text(const char* attribute) const override;
  [[nodiscard]] std::uint64_t bytes() const override { return bytes_; }

 protected:
  /// An array that lies in memory which somebody else keeps.
  void placeArray(const std::string& path, ArrayShape shape, std::span<const std::byte> bytes);

 private:
  struct Array {
    NumberType type{};
    std::vector<std::uint64_t> shape;
    std::unique_ptr<double[]>
        room;  ///< of `bytes`, aligned for any number; null where somebody else keeps it
    const std::byte* first{nullptr};
    std::size_t bytes{0};
  };

  [[nodiscard]] ArrayShape shape(const std::string& path, NumberType wanted) const override;
  [[nodiscard]] const std::byte* place(const std::string& path, std::uint64_t bytes) const override;
  [[nodiscard]] const Array& array(const std::string& path) const;
  template <typename T>
  [[nodiscard]] const T& attribute(const char* name, const char* expected) const;

  std::map<std::string, Attribute> attributes_;
  std::shared_ptr<std::map<std::string, Array>> arrays_{std::make_shared<std::map<std::string, Array>>()};
  std::uint64_t bytes_{0};
};

}  // namespace palpate
