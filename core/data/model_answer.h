// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/data/array_reader.h"
#include "core/data/model_source.h"
#include "core/data/sealed_image.h"

namespace palpate {

/// What the process that parses a model file (core/reader) writes of it: attributes, and where in the file arrays lie.
/// Numbers are in this machine's order of bytes: both ends are programs of one build.
class ModelAnswer {
 public:
  void addNumbers(std::string_view attribute, std::span<const double> values);
  void addText(std::string_view attribute, std::string_view text);
  /// @param offset  of its first byte in the file
  void addArray(std::string_view path, const ArrayShape& shape, std::uint64_t offset);
  /// All of it: an answer that was cut off lacks the end.
  [[nodiscard]] std::string whole() const;
  /// The other kind of answer. @param why  without the file's name
  [[nodiscard]] static std::string refusal(std::string_view why);

 private:
  std::string records_;
};

/// A model as such an answer describes it, its arrays where they lie in the sealed copy. The process that answers has parsed
/// a file that may be hostile, so nothing is believed: places within the copy, apart from each other, at multiples of
/// kArrayAlignment, sizes that follow from shapes. readModel() checks the rest, as of every source.
class AnsweredModel final : public ArrayReader {
 public:
  /// @param image  outlives the reader and all spans  @param name  how the file is called in messages
  /// @throw LoadError  the answer is a refusal, or is not to be believed
  AnsweredModel(const SealedImage& image, const std::string& name, std::string_view answer);

 private:
  class Records;
  struct Place {
    std::uint64_t begin, end;
    std::string path;
  };
  void requireRoom(std::uint64_t bytes) const override;
  void takeAttribute(char kind, const std::string& name, Records& records);
  void takeArray(const std::string& path, Records& records);
  void requireApart();
  [[noreturn]] void disbelieve(const std::string& what) const;

  const SealedImage& image_;
  std::vector<Place> places_;
};

}  // namespace palpate
