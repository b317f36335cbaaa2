// SPDX-License-Identifier: Apache-2.0
// Arrays that a file has in fewer bytes than tables of numbers want.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "../load_case.h"
#include "core/data/array_reader.h"
#include "core/data/load_error.h"
#include "core/data/model_content.h"
#include "core/model/field_evaluation.h"

namespace palpate::testing {

namespace {

/// Stores a dataset again, the same numbers in another type.
void storeAs(const std::filesystem::path& path, const char* dataset, hid_t type) {
  const Hdf5Handle file = openForSpoiling(path);
  const Hdf5Handle old(H5Dopen2(file.get(), dataset, H5P_DEFAULT), H5Dclose);
  const Hdf5Handle space(H5Dget_space(old.get()), H5Sclose);
  std::vector<double> numbers(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
  ASSERT_GE(H5Dread(old.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), 0);
  H5Lmove(file.get(), dataset, file.get(), "old", H5P_DEFAULT, H5P_DEFAULT);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY);
  const Hdf5Handle made(
      H5Dcreate2(file.get(), dataset, type, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Dclose);
  ASSERT_GE(H5Dwrite(made.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), 0);
}

}  // namespace

TEST(NarrowArrays, AreTheSameModel) {
  const TemporaryFile file("narrow.h5");
  modelfile::writeModel(file.path(), goodData());
  const std::string wide = MetaModel::load(file.path()).digest().hex();
  for (const auto& [dataset, type] : {std::pair<const char*, hid_t>{"contact/node", H5T_STD_I16LE},
                                      {"surface/mesh_tag", H5T_STD_I8LE},
                                      {"mesh/node_tag", H5T_STD_I32LE},
                                      {"near/offset", H5T_STD_I16LE}}) {
    storeAs(file.path(), dataset, type);
    const MetaModel model = MetaModel::load(file.path());
    EXPECT_EQ(model.digest().hex(), wide) << dataset;
    EXPECT_TRUE(sameBits(goodData().contact_node, model.view().contact_node));
    EXPECT_TRUE(sameBits(goodData().near_offset, model.view().near_offset));
    const Hdf5Handle spoiled = openForSpoiling(file.path());
    H5Ldelete(spoiled.get(), "old", H5P_DEFAULT);
  }
}

/// A model outlives the reader, and so do the copies of its numbers.
TEST(NarrowArrays, AreWhatACompactFileIsMadeOf) {
  const TemporaryFile file("compact.h5"), plain("plain.h5");
  modelfile::ModelData data = goodData();
  modelfile::writeModel(plain.path(), data);
  data.compact = true;
  modelfile::writeModel(file.path(), data);
  EXPECT_LT(std::filesystem::file_size(file.path()), std::filesystem::file_size(plain.path()));
  const Hdf5Handle stored = openForSpoiling(file.path());
  for (const auto& [dataset, bytes] : {std::pair<const char*, std::size_t>{"modes/X", 1},
                                       {"near/field", 1},
                                       {"near/node", 1},
                                       {"mesh/tetrahedra", 1},
                                       {"contact/force", 8},
                                       {"near/scale", 4}}) {
    const Hdf5Handle opened(H5Dopen2(stored.get(), dataset, H5P_DEFAULT), H5Dclose);
    const Hdf5Handle type(H5Dget_type(opened.get()), H5Tclose);
    EXPECT_EQ(H5Tget_size(type.get()), bytes) << dataset;
  }
  const MetaModel model = MetaModel::load(file.path());
  EXPECT_TRUE(sameBits(data.near_node, model.view().near_node));
  EXPECT_TRUE(sameBits(data.contact_force, model.view().contact_force));
}

/// Fields are read as they lie, so both widths go through kernels of their own.
TEST(NarrowArrays, FieldsInOneByteAreThoseInTwo) {
  const TemporaryFile file("bytes.h5");
  modelfile::ModelData data = syntheticModel({.subdivisions = 2, .modes = 9});
  data.compact = true;
  modelfile::writeModel(file.path(), data);
  std::array<std::vector<float>, 2> u;
  std::array<std::string, 2> digest;
  for (std::size_t width = 0; width < 2; ++width) {
    if (width == 1)
      for (const char* dataset : {"modes/X", "modes/Y", "near/field", "green/Y", "green/near"}) {
        storeAs(file.path(), dataset, H5T_STD_I16LE);
        const Hdf5Handle spoiled = openForSpoiling(file.path());
        H5Ldelete(spoiled.get(), "old", H5P_DEFAULT);
      }
    const MetaModel model = MetaModel::load(file.path());
    EXPECT_EQ(model.view().modes_X.int8() != nullptr, width == 0);
    EXPECT_EQ(model.view().green_near.int16() != nullptr, width == 1);
    u[width].resize(3 * model.view().surfaceNodes());
    FieldScratch scratch(model);
    const std::vector<std::uint8_t> accessible = model.accessibleNodes();
    std::int32_t triangle = 0;
    while (accessible[std::size_t(model.view().contact_triangles[3 * std::size_t(triangle)])] == 0)
      ++triangle;
    const FieldSource source{{triangle, {1.0, 0.0, 0.0}}, Vec3(2e-4, -1e-4, 1e-3), 1.0};
    evaluateField(model, std::span(&source, 1), scratch, u[width]);
    digest[width] = model.digest().hex();
  }
  EXPECT_GT(*std::max_element(u[0].begin(), u[0].end()), 1e-4F);
  EXPECT_EQ(u[0], u[1]);
  EXPECT_EQ(digest[0], digest[1]);
}

/// docs/model_file.md, Digest: of one byte each where that holds all numbers, whatever the file has.
TEST(NarrowArrays, FieldsAreDigestedInTheFewestBytes) {
  const TemporaryFile file("digested.h5");
  modelfile::writeModel(file.path(), syntheticModel({.subdivisions = 2, .modes = 9}));
  const MetaModel model = MetaModel::load(file.path());
  ModelView view = model.view();
  const auto digestOf = [&](const WholeNumbers& X) {
    view.modes_X = X;
    return contentDigest(model.attributes(), view).hex();
  };
  std::vector<std::int8_t> one(view.modes_X.size());
  ASSERT_NE(one.size() % 2048, 0U);
  ASSERT_GT(one.size(), 2048U);
  for (std::size_t i = 0; i < one.size(); ++i) one[i] = static_cast<std::int8_t>(int(i % 256) - 128);
  std::vector<std::int16_t> two(one.begin(), one.end());
  const std::string digest = digestOf(std::span<const std::int8_t>(one));
  EXPECT_EQ(digestOf(std::span<const std::int16_t>(two)), digest);
  for (const int beyond : {128, -129}) {
    const std::int16_t was = std::exchange(two[3000], static_cast<std::int16_t>(beyond));
    EXPECT_NE(digestOf(std::span<const std::int16_t>(two)), digest);
    two[3000] = was;
  }
  view.near_field = std::span<const std::int8_t>();
  const std::string without = digestOf(std::span<const std::int8_t>(one));
  view.near_field = std::span<const std::int16_t>();
  EXPECT_EQ(digestOf(std::span<const std::int8_t>(one)), without);
}

TEST(NarrowArrays, AreWidenedExactly) {
  ArrayReader reader("page.h5");
  const std::array<float, 2> numbers{0.5F, -3.0F};
  std::memcpy(reader.addArray("contact/domain_radius", NumberType::kF32, {2}, sizeof numbers), numbers.data(),
              sizeof numbers);
  const std::array<std::int8_t, 3> whole{-128, 0, 127};
  std::memcpy(reader.addArray("near/offset", NumberType::kI8, {3}, sizeof whole), whole.data(), sizeof whole);
  Lengths lengths;
  const auto radius = reader.dataset(dataset::kContactDomainRadius, lengths);
  const auto offset = reader.dataset(dataset::kNearOffset, lengths);
  EXPECT_EQ(radius[1], -3.0);
  EXPECT_EQ(offset[0], -128);
  EXPECT_EQ(offset[2], 127);
  EXPECT_EQ(lengths.value("M"), 2U);
}

/// Positions may have amplitudes of fewer modes than there are, not of more.
TEST(NarrowArrays, AmplitudesOfMoreModesThanThereAreAreRefused) {
  const TemporaryFile file("more-modes.h5");
  const modelfile::ModelData& data = goodData();
  modelfile::writeModel(file.path(), data);
  const std::size_t modes = data.modes_X.size() / data.surface_positions.size(),
                    positions = data.contact_node.size();
  replaceDataset(file.path(), "modes/Y", H5T_STD_I16LE,
                 {positions, data.modes_Y.size() / positions / modes, modes + 1});
  expectRefused(file.path(), "/modes/Y has " + std::to_string(modes + 1) +
                                 " modes, expected at most n = " + std::to_string(modes));
}

/// Whole numbers are no floats, and in more bytes than wanted there could be numbers that do not fit.
TEST(NarrowArrays, OtherTypesAreRefused) {
  EXPECT_TRUE(isNarrower(NumberType::kI8, NumberType::kI64));
  for (const auto& [stored, wanted] : {std::pair{NumberType::kI32, NumberType::kI16},
                                       {NumberType::kF64, NumberType::kF32},
                                       {NumberType::kI16, NumberType::kF64},
                                       {NumberType::kF32, NumberType::kI64},
                                       {NumberType::kI8, NumberType::kU8},
                                       {NumberType::kU8, NumberType::kI16},
                                       {NumberType::kI16, NumberType::kI16}})
    EXPECT_FALSE(isNarrower(stored, wanted));
}

}  // namespace palpate::testing
