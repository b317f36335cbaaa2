// SPDX-License-Identifier: Apache-2.0
// Every way in which a model file can be wrong, each with its wrong value and its message.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

#include "palpate/core/hdf5_handle.h"
#include "palpate/core/meta_model.h"
#include "palpate/modelfile/model_file.h"
#include "palpate/testing/synthetic_model.h"
#include "spoiled_file.h"

namespace palpate::testing {

namespace {

using modelfile::ModelData;
using ::testing::HasSubstr;

const ModelData& goodData() {
  static const ModelData data = syntheticModel({.subdivisions = 1, .modes = 2});
  return data;
}

std::vector<char> readBytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void writeBytes(const std::filesystem::path& path, const std::vector<char>& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

struct Case {
  std::string name;
  std::string expected;
};

constexpr auto kCaseName = [](const auto& test) { return test.param.name; };

}  // namespace

// ---- numbers that do not make sense
// ------------------------------------------------------------------------------

struct WrongNumbers : Case {
  std::function<void(ModelData&)> spoil;
};

class LoadRefusesNumbers : public ::testing::TestWithParam<WrongNumbers> {};

TEST_P(LoadRefusesNumbers, WithOneClearLine) {
  ModelData data = goodData();
  GetParam().spoil(data);
  const TemporaryFile file("numbers.h5");
  modelfile::writeModel(file.path(), data);
  expectRefused(file.path(), GetParam().expected);
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

INSTANTIATE_TEST_SUITE_P(
    All, LoadRefusesNumbers,
    ::testing::
        Values(
            WrongNumbers{{"Law", R"(law is "hooke", expected "stvk")"},
                         [](ModelData& d) { d.attributes.law = "hooke"; }},
            WrongNumbers{{"NegativeE", "E is -1, expected more than 0 Pa"},
                         [](ModelData& d) { d.attributes.E = -1.0; }},
            WrongNumbers{{"NanE", "E is nan, expected more than 0 Pa"},
                         [](ModelData& d) { d.attributes.E = kNaN; }},
            WrongNumbers{{"Incompressible", "nu is 0.5, expected more than -1 and less than 0.5"},
                         [](ModelData& d) { d.attributes.nu = 0.5; }},
            WrongNumbers{{"PatchRadius", "patch_radius is 0, expected more than 0 m"},
                         [](ModelData& d) { d.attributes.patch_radius = 0.0; }},
            WrongNumbers{{"NearRadius", "near_radius is -0.01, expected at least 0 m"},
                         [](ModelData& d) { d.attributes.near_radius = -0.01; }},
            WrongNumbers{{"ReferenceDisplacement", "reference_displacement is 0, expected more than 0 m"},
                         [](ModelData& d) { d.attributes.reference_displacement = 0.0; }},
            WrongNumbers{{"NanPosition", "/surface/positions number 7 is nan, expected a finite number"},
                         [](ModelData& d) { d.surface_positions[7] = kNaN; }},
            WrongNumbers{{"NanForce", "/contact/force number 3 is nan, expected a finite number"},
                         [](ModelData& d) { d.contact_force[3] = kNaN; }},
            WrongNumbers{{"InfiniteMode", "/modes/X number 5 is inf, expected a finite number"},
                         [](ModelData& d) { d.modes_X[5] = kInfinity; }},
            WrongNumbers{{"InfiniteAmplitude", "/modes/Y number 0 is inf"},
                         [](ModelData& d) { d.modes_Y[0] = kInfinity; }},
            WrongNumbers{{"InfiniteNearField", "/near/field number 9 is inf"},
                         [](ModelData& d) { d.near_field[9] = kInfinity; }},
            WrongNumbers{{"NegativeDomain", "/contact/domain_radius number 2 is -0.001, expected at least 0"},
                         [](ModelData& d) { d.contact_domain_radius[2] = -0.001; }},
            WrongNumbers{{"TriangleIndex", "/surface/triangles number 4 is 42, expected 0 to 41"},
                         [](ModelData& d) { d.surface_triangles[4] = 42; }},
            WrongNumbers{{"NegativeTriangleIndex", "/surface/triangles number 4 is -1, expected 0 to 41"},
                         [](ModelData& d) { d.surface_triangles[4] = -1; }},
            WrongNumbers{{"ContactNode", "/contact/node number 1 is 1000, expected 0 to 41"},
                         [](ModelData& d) { d.contact_node[1] = 1000; }},
            WrongNumbers{{"ContactNodeTwice", "expected 1"},
                         [](ModelData& d) { d.contact_node[1] = d.contact_node[0]; }},
            WrongNumbers{{"PositionOfNode", "/surface/position_of_node number"},
                         [](ModelData& d) { d.position_of_node[0] = 99; }},
            WrongNumbers{{"PositionClaimedTwice", "/surface/position_of_node names"},
                         [](ModelData& d) {
                           *std::find(d.position_of_node.begin(), d.position_of_node.end(), -1) = 0;
                         }},
            WrongNumbers{{"AccessibleFlag", "/contact/accessible number 3 is 2, expected 0 or 1"},
                         [](ModelData& d) { d.contact_accessible[3] = 2; }},
            WrongNumbers{{"NearOffsetStart", "/near/offset begins with 1, expected 0"},
                         [](ModelData& d) { d.near_offset[0] = 1; }},
            WrongNumbers{{"NearOffsetFalls", "/near/offset number 2 is 0, expected at least"},
                         [](ModelData& d) { d.near_offset[2] = 0; }},
            WrongNumbers{{"NearOffsetHuge", "/near/offset number 1 is 9223372036854775807"},
                         [](ModelData& d) { d.near_offset[1] = std::numeric_limits<std::int64_t>::max(); }},
            WrongNumbers{{"NearOffsetEnd", "/near/offset ends with"},
                         [](ModelData& d) { d.near_offset.back() -= 1; }},
            WrongNumbers{{"NearNode", "/near/node number 0 is 42, expected 0 to 41"},
                         [](ModelData& d) { d.near_node[0] = 42; }},
            WrongNumbers{{"NearNodeTwice", "again, expected each node once at position 0"},
                         [](ModelData& d) {
                           d.near_offset[1] = d.near_offset[2];  // takes over the nodes of position 1
                           d.near_node[1] = d.near_node[0];
                         }},
            WrongNumbers{{"Tetrahedron", "/mesh/tetrahedra number 8 is -3"},
                         [](ModelData& d) { d.mesh_tetrahedra[8] = -3; }},
            WrongNumbers{{"FixedNode", "/mesh/fixed number 0 is 43, expected 0 to 42"},
                         [](ModelData& d) { d.mesh_fixed[0] = 43; }},
            WrongNumbers{{"SurfaceNode", "/mesh/surface_node number 0 is 43"},
                         [](ModelData& d) { d.mesh_surface_node[0] = 43; }},
            WrongNumbers{{"OpenSurface", "has no neighbour across the edge"},
                         [](ModelData& d) { d.surface_triangles.resize(d.surface_triangles.size() - 3); }},
            WrongNumbers{{"TurnedTriangle", "repeats the edge"},
                         [](ModelData& d) { std::swap(d.surface_triangles[0], d.surface_triangles[1]); }},
            WrongNumbers{{"FlatTriangle", "has no area"},
                         [](ModelData& d) { d.surface_triangles[1] = d.surface_triangles[0]; }},
            WrongNumbers{{"LooseNode", "/surface/positions number 42 belongs to no triangle"},
                         [](ModelData& d) {
                           d.surface_positions.insert(d.surface_positions.end(), {1.0, 1.0, 1.0});
                           d.surface_mesh_tag.push_back(99);
                           d.position_of_node.push_back(-1);
                           d.mesh_surface_node.push_back(0);
                           d.modes_X.resize(3 * d.surface_mesh_tag.size() * 2);
                         }}),
    kCaseName);

// ---- files that are not what they should be
// ----------------------------------------------------------------------

struct WrongBytes : Case {
  std::function<void(std::vector<char>&)> spoil;
};

class LoadRefusesBytes : public ::testing::TestWithParam<WrongBytes> {};

TEST_P(LoadRefusesBytes, WithOneClearLine) {
  const TemporaryFile file("bytes.h5");
  modelfile::writeModel(file.path(), goodData());
  std::vector<char> bytes = readBytes(file.path());
  GetParam().spoil(bytes);
  writeBytes(file.path(), bytes);
  expectRefused(file.path(), GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    All, LoadRefusesBytes,
    ::testing::Values(WrongBytes{{"Empty", "is empty, expected a model file"}, [](auto& b) { b.clear(); }},
                      WrongBytes{{"Truncated", "truncated"}, [](auto& b) { b.resize(b.size() / 2); }},
                      WrongBytes{{"TruncatedByOne", "truncated"}, [](auto& b) { b.pop_back(); }},
                      WrongBytes{{"SignatureOnly", "truncated or damaged"}, [](auto& b) { b.resize(8); }},
                      WrongBytes{{"Text", "does not begin with the HDF5 signature"},
                                 [](auto& b) { b = {'s', 'o', 'l', 'i', 'd', ' ', 'x', '\n', '1'}; }},
                      WrongBytes{{"GarbageBehindTheSignature", "truncated or damaged"},
                                 [](auto& b) { std::fill(b.begin() + 8, b.end(), '\xA5'); }}),
    kCaseName);

TEST(Load, RefusesAMissingFileADirectoryAndAPipe) {
  expectRefused("/nonexistent/model.h5", "cannot be opened: No such file or directory");
  expectRefused("/tmp", "is no regular file");
  expectRefused("/dev/null", "is no regular file");
}

TEST(Load, SurvivesDamagedBytes) {
#if defined(__SANITIZE_ADDRESS__)
  const __lsan::ScopedDisabler hdf5_itself_leaks_on_damaged_headers;  // a few hundred bytes, seen with 1.10.8
#endif
  const TemporaryFile file("fuzz.h5");
  modelfile::writeModel(file.path(), goodData());
  const std::vector<char> good = readBytes(file.path());
  std::mt19937 random(7);
  int refused = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<char> bytes = good;
    for (int flips = 0; flips < 4; ++flips) bytes[random() % bytes.size()] = static_cast<char>(random());
    for (int flips = 0; flips < 2; ++flips) bytes[random() % 2048] = static_cast<char>(random());
    writeBytes(file.path(), bytes);
    const std::string text = complaint(file.path());
    refused += text.empty() ? 0 : 1;
    ASSERT_EQ(std::count(text.begin(), text.end(), '\n'), 0) << text;
  }
  EXPECT_GT(refused, 10);
}

// ---- HDF5 that cannot be mapped
// ----------------------------------------------------------------------------------

namespace {

struct Replacement {
  hid_t type{H5T_IEEE_F64LE};
  std::vector<hsize_t> shape{};  ///< empty: that of the good /contact/force
  std::function<void(hid_t)> creation{[](hid_t) {}};
  bool write{true};
  hsize_t alignment{4096};
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

struct WrongLayout : Case {
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
      replaced("SinglePrecision",
               "/contact/force is little-endian 32-bit float, expected little-endian 64-bit float",
               {.type = H5T_IEEE_F32LE}),
      replaced("Integers", "/contact/force is little-endian 64-bit integer, expected",
               {.type = H5T_STD_I64LE}),
      replaced("Chunked", "/contact/force is chunked, expected contiguous", {.creation = chunk}),
      replaced("Compressed", "/contact/force has 1 filters", {.creation = compress}),
      replaced("LateAllocated", "/contact/force has no place in the file (late allocation)",
               {.creation = allocateLate, .write = false}),
      replaced("External", "/contact/force lies in another file",
               {.creation = storeElsewhere, .write = false}),
      replaced("Unaligned", "expected a multiple of 4096", {.alignment = 1}),
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
      {{"MissingGroup", "/near is missing"}, [](const auto& p) { deleteThing(p, nullptr, "near"); }},
      {{"MissingAttribute", "attribute nu is missing"}, [](const auto& p) { deleteThing(p, "nu", nullptr); }},
      {{"NoModelAtAll", "attribute format is missing"},
       [](const auto& p) { deleteThing(p, "format", nullptr); }},
      {{"Version", "attribute version is 3, expected 1 or 2"},
       [](const auto& p) { setNumber(p, "version", H5T_NATIVE_INT, 3); }},
      {{"NoParameters", "attribute parameters is missing"},
       [](const auto& p) { setNumber(p, "version", H5T_NATIVE_INT, 2); }},
      {{"Order", "attribute order is 8, expected 1 to 7"},
       [](const auto& p) { setNumber(p, "order", H5T_NATIVE_INT, 8); }},
      {{"ForceOrderBelowTheFields", "attribute force_order is 2, expected 3 to 7"},
       [](const auto& p) { setNumber(p, "force_order", H5T_NATIVE_INT, 2); }},
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

// ---- files that are right
// ----------------------------------------------------------------------------------------

namespace {

template <typename T>
bool sameBits(const std::vector<T>& a, std::span<const T> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), b.size_bytes()) == 0);
}

}  // namespace

TEST(Load, GivesBackEveryBitThatWasWritten) {
  const TemporaryFile file("round-trip.h5");
  const ModelData& d = goodData();
  modelfile::writeModel(file.path(), d);
  const MetaModel model = MetaModel::load(file.path());
  const ModelView& v = model.view();
  EXPECT_TRUE(sameBits(d.surface_positions, v.surface_positions));
  EXPECT_TRUE(sameBits(d.surface_triangles, v.surface_triangles));
  EXPECT_TRUE(sameBits(d.surface_mesh_tag, v.surface_mesh_tag));
  EXPECT_TRUE(sameBits(d.position_of_node, v.position_of_node));
  EXPECT_TRUE(sameBits(d.contact_node, v.contact_node));
  EXPECT_TRUE(sameBits(d.contact_accessible, v.contact_accessible));
  EXPECT_TRUE(sameBits(d.contact_force, v.contact_force));
  EXPECT_TRUE(sameBits(d.contact_domain_radius, v.contact_domain_radius));
  EXPECT_TRUE(sameBits(d.modes_X, v.modes_X));
  EXPECT_TRUE(sameBits(d.modes_Y, v.modes_Y));
  EXPECT_TRUE(sameBits(d.near_offset, v.near_offset));
  EXPECT_TRUE(sameBits(d.near_node, v.near_node));
  EXPECT_TRUE(sameBits(d.near_field, v.near_field));
  EXPECT_TRUE(sameBits(d.mesh_nodes, v.mesh_nodes));
  EXPECT_TRUE(sameBits(d.mesh_tetrahedra, v.mesh_tetrahedra));
  EXPECT_TRUE(sameBits(d.mesh_node_tag, v.mesh_node_tag));
  EXPECT_TRUE(sameBits(d.mesh_tetrahedron_tag, v.mesh_tetrahedron_tag));
  EXPECT_TRUE(sameBits(d.mesh_fixed, v.mesh_fixed));
  EXPECT_TRUE(sameBits(d.mesh_surface_node, v.mesh_surface_node));
  const ModelAttributes &a = d.attributes, &b = model.attributes();
  EXPECT_EQ(std::tie(a.model_id, a.law, a.provenance, a.E, a.nu, a.order, a.patch_radius, a.near_radius,
                     a.reference_displacement),
            std::tie(b.model_id, b.law, b.provenance, b.E, b.nu, b.order, b.patch_radius, b.near_radius,
                     b.reference_displacement));
  EXPECT_EQ(model.bytes(), std::filesystem::file_size(file.path()));
}

TEST(Load, TakesAModelWithoutModesAndNearField) {
  ModelData d = goodData();
  d.modes_X.clear();
  d.modes_Y.clear();
  d.near_node.clear();
  d.near_field.clear();
  std::fill(d.near_offset.begin(), d.near_offset.end(), 0);
  d.mesh_fixed.clear();
  const TemporaryFile file("response-only.h5");
  modelfile::writeModel(file.path(), d);
  EXPECT_EQ(complaint(file.path()), "");
  EXPECT_EQ(MetaModel::load(file.path()).view().modes(), 0U);
}

TEST(Load, LongProvenanceComesBack) {
  ModelData d = goodData();
  d.attributes.provenance = "{\"case\": \"" + std::string(300000, 'x') + "\"}";
  const TemporaryFile file("long.h5");
  modelfile::writeModel(file.path(), d);
  EXPECT_EQ(MetaModel::load(file.path()).attributes().provenance, d.attributes.provenance);
}

TEST(Load, ModelOutlivesItsFile) {
  const TemporaryFile file("gone.h5");
  modelfile::writeModel(file.path(), goodData());
  const MetaModel model = MetaModel::load(file.path());
  std::filesystem::resize_file(file.path(), 0);
  EXPECT_TRUE(sameBits(goodData().near_field, model.view().near_field));
}

TEST(Load, LeavesNoHandleBehind) {
  const TemporaryFile good("handles.h5"), bad("handles-bad.h5");
  modelfile::writeModel(good.path(), goodData());
  ModelData d = goodData();
  d.attributes.nu = 0.7;
  modelfile::writeModel(bad.path(), d);
  for (int i = 0; i < 3; ++i) complaint(good.path()), complaint(bad.path());
  EXPECT_EQ(H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL), 0);
}

TEST(Load, SealedCopyCannotBeWritten) {
  const TemporaryFile file("sealed.h5");
  modelfile::writeModel(file.path(), goodData());
  const SealedImage image(file.path());
  EXPECT_LT(::write(image.descriptor(), "x", 1), 0);
  EXPECT_LT(::ftruncate(image.descriptor(), 0), 0);
}

}  // namespace palpate::testing
