// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/data/hdf5_handle.h"
#include "core/data/model_answer.h"
#include "core/data/model_source.h"

namespace palpate {

/// A file that may be hostile: link, layout, filters and place of each array are checked too. What it finds is also put into an
/// answer, and no number of an array is looked at. HDF5 trusts what it reads, so this is for a process that may do nothing else
/// (sandbox.h). Does not include HDF5 itself.
class Hdf5Reader final : public ModelSource {
 public:
  /// @param file  all of it; outlives the reader, as the answer does. Messages are without its name.
  Hdf5Reader(std::span<const std::byte> file, ModelAnswer& answer);

  [[nodiscard]] bool hasAttribute(const char* attribute) const override;
  [[nodiscard]] bool hasDataset(const std::string& path) const override;
  void numbers(const char* attribute, std::span<double> values) const override;
  [[nodiscard]] int integer(const char* attribute) const override;
  [[nodiscard]] std::string text(const char* attribute) const override;

 private:
  [[nodiscard]] ArrayShape shape(const std::string& path, NumberType wanted) const override;
  [[nodiscard]] const std::byte* place(const std::string& path, std::uint64_t bytes) const override;
  [[nodiscard]] std::uint64_t bytes() const override { return image_.size(); }
  [[nodiscard]] Hdf5Handle openImage() const;
  [[nodiscard]] Hdf5Handle openAttribute(const char* attribute, int values) const;
  [[nodiscard]] Hdf5Handle openDataset(const std::string& path) const;
  [[nodiscard]] std::uint64_t offsetOf(const std::string& path, std::uint64_t bytes) const;
  void checkLink(const std::string& path) const;
  void checkLayout(const std::string& path, std::int64_t dataset) const;

  std::span<const std::byte> image_;
  ModelAnswer& answer_;
  mutable ArrayShape shape_;  // of the dataset whose place is asked for next
  Hdf5Handle file_;
};

}  // namespace palpate
