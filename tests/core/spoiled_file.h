// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/data/hdf5_handle.h"
#include "core/model/meta_model.h"

namespace palpate::testing {

/// What load() says about a file; empty when it says nothing.
inline std::string complaint(const std::filesystem::path& path) {
  try {
    const MetaModel model = MetaModel::load(path);
    return {};
  } catch (const LoadError& error) {
    return error.what();
  }
}

inline void expectRefused(const std::filesystem::path& path, const std::string& expected) {
  const std::string text = complaint(path);
  EXPECT_THAT(text, ::testing::HasSubstr(expected));
  EXPECT_THAT(text, ::testing::HasSubstr(path.string()));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 0) << "one line, not " << text;
}

/// Opens a good file for spoiling, with the alignment of the writer.
inline Hdf5Handle openForSpoiling(const std::filesystem::path& path, hsize_t alignment = 64) {
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_alignment(access.get(), 0, alignment);
  return {H5Fopen(path.c_str(), H5F_ACC_RDWR, access.get()), H5Fclose};
}

template <typename T>
void setNumber(const std::filesystem::path& path, const char* name, hid_t type, T value) {
  const Hdf5Handle file = openForSpoiling(path);
  H5Adelete(file.get(), name);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(file.get(), name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  H5Awrite(attribute.get(), type, &value);
}

inline void deleteThing(const std::filesystem::path& path, const char* attribute, const char* link) {
  const Hdf5Handle file = openForSpoiling(path);
  if (attribute != nullptr) H5Adelete(file.get(), attribute);
  if (link != nullptr) H5Ldelete(file.get(), link, H5P_DEFAULT);
}

/// A dataset in the place of another, with room for its numbers, which are not written.
inline void replaceDataset(const std::filesystem::path& path, const char* dataset, hid_t type,
                           const std::vector<hsize_t>& shape) {
  const Hdf5Handle file = openForSpoiling(path);
  H5Ldelete(file.get(), dataset, H5P_DEFAULT);
  const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER);
  const Hdf5Handle made(
      H5Dcreate2(file.get(), dataset, type, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Dclose);
  ASSERT_TRUE(made.valid());
}

}  // namespace palpate::testing
