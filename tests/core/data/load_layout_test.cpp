// SPDX-License-Identifier: Apache-2.0
// HDF5 that is well-formed and cannot be mapped as a model.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <functional>

#include "../load_case.h"
#include "core/data/hdf5_handle.h"

namespace palpate::testing {

namespace {

struct Replacement {
  hid_t type{H5T_IEEE_F64LE};
  std::vector<hsize_t> shape{};  ///< empty: that of the good /contact/force
  std::function<void(hid_t)> creation{[](hid_t) {}};
  bool write{true};
  hsize_t alignment{64};
  const char* dataset{"contact/force"};
};

std::vector<hsize_t> forceShape() {
  return {goodData().contact_node.size(), 19, 3};
}

/// Puts another dataset in the place of /contact/force.
void replaceForce(const std::filesystem::path& path, const Replacement& r) {
  const Hdf5Handle file = openForSpoiling(path, r.alignment);
  // Moved, not deleted: its room in the file must not be given to the new one.
  H5Lmove(file.get(), r.dataset, file.get(), "old", H5P_DEFAULT, H5P_DEFAULT);
  const std::vector<hsize_t> shape = r.shape.empty() ? forceShape() : r.shape;
  const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  r.creation(creation.get());
  const Hdf5Handle data(
      H5Dcreate2(file.get(), r.dataset, r.type, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
      H5Dclose);
  ASSERT_TRUE(data.valid());
  if (!r.write) return;
  const std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())), 1.0);
  H5Dwrite(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

}  // namespace

struct WrongLayout : LoadCase {
  std::function<void(const std::filesystem::path&)> spoil;
};

class LoadRefusesLayout : public ::testing::TestWithParam<WrongLayout> {};

TEST_P(LoadRefusesLayout, WithOneClearLine) {
  const TemporaryFile file("layout.h5");
  modelfile::writeModel(file.path(), goodData());
  ASSERT_EQ(complaint(file.path()), "");
  GetParam().spoil(file.path());
  expectRefused(file.path(), GetParam().expected);
}

namespace {

const std::array<hsize_t, 3> kChunk{4, 19, 3};

void chunk(hid_t creation) {
  H5Pset_chunk(creation, 3, kChunk.data());
}

void compress(hid_t creation) {
  chunk(creation);
  H5Pset_deflate(creation, 4);
}

void allocateLate(hid_t creation) {
  H5Pset_alloc_time(creation, H5D_ALLOC_TIME_LATE);
}

void storeElsewhere(hid_t creation) {
  H5Pset_external(creation, "/dev/zero", 0, H5F_UNLIMITED);
}

WrongLayout replaced(const std::string& name, const std::string& expected, const Replacement& replacement) {
  return {{name, expected}, [replacement](const auto& path) { replaceForce(path, replacement); }};
}

void linkForce(const std::filesystem::path& path, bool external) {
  const Hdf5Handle file = openForSpoiling(path);
  H5Lmove(file.get(), "contact/force", file.get(), "elsewhere", H5P_DEFAULT, H5P_DEFAULT);
  if (external)
    H5Lcreate_external("/tmp/other.h5", "/force", file.get(), "contact/force", H5P_DEFAULT, H5P_DEFAULT);
  else
    H5Lcreate_soft("/elsewhere", file.get(), "contact/force", H5P_DEFAULT, H5P_DEFAULT);
}

std::vector<WrongLayout> layouts() {
  const std::string M = std::to_string(forceShape()[0]);
  return {
      replaced("BigEndian", "/contact/force is big-endian 64-bit float, expected little-endian 64-bit float",
               {.type = H5T_IEEE_F64BE}),
      replaced("MoreBytesThanWanted",
               "/near/node is little-endian 64-bit integer, expected little-endian 32-bit integer",
               {.type = H5T_STD_I64LE, .dataset = "near/node"}),
      replaced("Unsigned", "/near/node is little-endian 16-bit unsigned integer, expected",
               {.type = H5T_STD_U16LE, .dataset = "near/node"}),
      replaced("Integers", "/contact/force is little-endian 64-bit integer, expected",
               {.type = H5T_STD_I64LE}),
      replaced("Chunked", "/contact/force is chunked, expected contiguous", {.creation = chunk}),
      replaced("Compressed", "/contact/force has 1 filters", {.creation = compress}),
      replaced("LateAllocated", "/contact/force has no place in the file (late allocation)",
               {.creation = allocateLate, .write = false}),
      replaced("External", "/contact/force lies in another file",
               {.creation = storeElsewhere, .write = false}),
      replaced("Unaligned", "expected a multiple of 64", {.alignment = 1000}),
      replaced("WrongShape", "/contact/force has shape " + M + " x 9 x 3, expected M = " + M + " x 19 x 3",
               {.shape = {forceShape()[0], 9, 3}}),
      replaced("WrongRank", "/contact/force has shape 57, expected", {.shape = {57}}),
      replaced("Overflow", "/contact/force has shape 4611686018427387904 x 19 x 3",
               {.shape = {1ULL << 62U, 19, 3}, .creation = chunk, .write = false}),
      replaced(
          "MoreThanTheFile", "/mesh/nodes has more numbers than the file's",
          {.shape = {100'000'000, 3}, .creation = allocateLate, .write = false, .dataset = "mesh/nodes"}),
      {{"SoftLink", "/contact/force is a link to somewhere else"},
       [](const auto& p) { linkForce(p, false); }},
      {{"ExternalLink", "/contact/force is a link to somewhere else"},
       [](const auto& p) { linkForce(p, true); }},
      {{"MissingDataset", "/modes/Y is missing"}, [](const auto& p) { deleteThing(p, nullptr, "modes/Y"); }},
      {{"MissingStiffness", "/contact/stiffness is missing"},
       [](const auto& p) { deleteThing(p, nullptr, "contact/stiffness"); }},
      {{"MissingGreens", "/green is missing"}, [](const auto& p) { deleteThing(p, nullptr, "green"); }},
      {{"MissingGreensNearField", "/green/near is missing"},
       [](const auto& p) { deleteThing(p, nullptr, "green/near"); }},
      replaced("GreensOfAnotherModesNumber", "/green/Y has shape 4 x 3 x 3, expected",
               {.type = H5T_STD_I16LE, .shape = {4, 3, 3}, .dataset = "green/Y"}),
      {{"MissingGroup", "/near is missing"}, [](const auto& p) { deleteThing(p, nullptr, "near"); }},
      {{"MissingAttribute", "attribute nu is missing"}, [](const auto& p) { deleteThing(p, "nu", nullptr); }},
      {{"NoModelAtAll", "attribute format is missing"},
       [](const auto& p) { deleteThing(p, "format", nullptr); }},
      {{"Version",
        ".h5: version 2 of the model file; this program reads version 6: solve the organ again with "
        "palpate-solve"},
       [](const auto& p) { setNumber(p, "version", H5T_NATIVE_INT, 2); }},
      {{"NoParameters", "attribute parameters is missing"},
       [](const auto& p) { deleteThing(p, "parameters", nullptr); }},
      {{"NoContactTriangles", "/contact/triangles is missing"},
       [](const auto& p) { deleteThing(p, nullptr, "contact/triangles"); }},
      {{"Order", "attribute order is 8, expected 1 to 7"},
       [](const auto& p) { setNumber(p, "order", H5T_NATIVE_INT, 8); }},
      {{"ForceOrderBelowTheFields", "attribute force_order is 2, expected 3 to 8"},
       [](const auto& p) { setNumber(p, "force_order", H5T_NATIVE_INT, 2); }},
      {{"ForceOrder", "attribute force_order is 9, expected 3 to 8"},
       [](const auto& p) { setNumber(p, "force_order", H5T_NATIVE_INT, 9); }},
      {{"ForceOrderAboveTheData",
        "/contact/force has shape " + M + " x 19 x 3, expected M = " + M + " x 34 x 3"},
       [](const auto& p) { setNumber(p, "force_order", H5T_NATIVE_INT, 4); }},
      {{"FormatIsNoText", "attribute format is no readable text"},
       [](const auto& p) { setNumber(p, "format", H5T_NATIVE_INT, 1); }},
      {{"EIsNoFloat", "attribute E is little-endian 32-bit integer, expected a float"},
       [](const auto& p) { setNumber(p, "E", H5T_NATIVE_INT, 1); }},
      {{"OrderIsNoInteger", "attribute order is little-endian 64-bit float, expected an integer"},
       [](const auto& p) { setNumber(p, "order", H5T_NATIVE_DOUBLE, 3.0); }},
  };
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(All, LoadRefusesLayout, ::testing::ValuesIn(layouts()), kCaseName);

}  // namespace palpate::testing
