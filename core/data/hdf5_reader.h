// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/data/hdf5_handle.h"
#include "core/data/model_source.h"
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

/// A file that may be hostile: link, layout, filters and place of each array are checked too. Does not include HDF5 itself.
class Hdf5Reader final : public ModelSource {
 public:
  /// @param image  outlives the reader and all spans  @param name  how the file is called in messages
  Hdf5Reader(const SealedImage& image, std::string name);

  [[nodiscard]] bool hasAttribute(const char* attribute) const override;
  [[nodiscard]] bool hasDataset(const std::string& path) const override;
  void numbers(const char* attribute, std::span<double> values) const override;
  [[nodiscard]] int integer(const char* attribute) const override;
  [[nodiscard]] std::string text(const char* attribute) const override;

 private:
  [[nodiscard]] ArrayShape shape(const std::string& path, NumberType wanted) const override;
  [[nodiscard]] const std::byte* place(const std::string& path, std::uint64_t bytes) const override;
  [[nodiscard]] std::uint64_t bytes() const override { return image_.bytes().size(); }
  void requireRoom(std::uint64_t bytes) const override;
  [[nodiscard]] Hdf5Handle openImage() const;
  [[nodiscard]] Hdf5Handle openAttribute(const char* attribute, int values) const;
  [[nodiscard]] Hdf5Handle openDataset(const std::string& path) const;
  void checkLink(const std::string& path) const;
  void checkLayout(const std::string& path, std::int64_t dataset) const;

  Hdf5Silence silence_;  // first: silences HDF5 from opening to closing
  const SealedImage& image_;
  Hdf5Handle file_;
};

}  // namespace palpate
