// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/data/hdf5_handle.h"
#include "core/data/load_error.h"
#include "core/model/field_evaluation.h"
#include "core/model/meta_model.h"
#include "core/model/mode_selection.h"
#include "core/response/patch_response.h"
#include "palpate/testing/synthetic_model.h"
#include "tools/modelfile/mixed_precision.h"
#include "tools/modelfile/pack_modes.h"
#include "tools/modelfile/write_model.h"

namespace palpate::testing {

namespace {

using modelfile::ModelData;
using modelfile::StorageReport;
using ::testing::HasSubstr;

/// Modes that fall by a fifth each: some need more bits than others.
ModelData fallingModes(SyntheticOptions options = {.subdivisions = 2, .modes = 24}) {
  ModelData data = syntheticModel(options);
  for (std::size_t i = 0; i < data.modes_Y.size(); ++i)
    data.modes_Y[i] *= std::pow(0.8F, static_cast<float>(i % static_cast<std::size_t>(options.modes)));
  return data;
}

MetaModel load(const ModelData& data) {
  const TemporaryFile file("mixed.h5");
  modelfile::writeModel(file.path(), data);
  return MetaModel::load(file.path());
}

std::vector<float> field(const MetaModel& model, const ContactPoint& s, const Vec3& d) {
  FieldScratch scratch(model);
  std::vector<float> u(3 * model.view().surfaceNodes());
  evaluateField(model, s, d, scratch, u);
  return u;
}

float largestNode(std::span<const float> u) {
  float largest = 0.0F;
  for (std::size_t i = 0; i < u.size(); i += 3)
    largest = std::max(largest, std::hypot(u[i], u[i + 1], u[i + 2]));
  return largest;
}

void resizeTiles(ModelData& data, std::ptrdiff_t more) {
  modelfile::PackedModesData& packed = data.modes_packed;
  const std::size_t X16 = packed.X16.size() / packed.tiles, X8 = packed.X8.size() / packed.tiles;
  packed.tiles = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(packed.tiles) + more);
  packed.X16.resize(packed.tiles * X16);
  packed.X8.resize(packed.tiles * X8);
}

std::string complaint(const ModelData& data) {
  try {
    (void)load(data);
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

}  // namespace

TEST(StoreMixed, RoundingStaysWithinATenthOfTheModelsError) {
  for (const double own : {1e-3, 3e-3, 1.0}) {
    ModelData data = fallingModes();
    const StorageReport report = modelfile::storeMixed(data, own);
    EXPECT_DOUBLE_EQ(report.error_limit, std::min(0.1 * own, modelfile::kMostRounding));
    EXPECT_LE(report.error_max, report.error_limit);
    EXPECT_GT(report.error_max, 0.0) << "nothing was rounded";
    EXPECT_EQ(report.counts.all(), 24U);
  }
}

TEST(StoreMixed, FewerBitsWhereMoreErrorIsAllowed) {
  ModelData strict = fallingModes(), loose = fallingModes();
  const StorageReport few = modelfile::storeMixed(loose, 1.0), many = modelfile::storeMixed(strict, 2e-4);
  EXPECT_LT(few.bytes, many.bytes);
  EXPECT_GT(few.counts.bits8, many.counts.bits8);
  EXPECT_LT(many.bytes, sizeof(float) * strict.modes_X.size());
}

TEST(StoreMixed, ModesThatMoveNothingHaveNoTiles) {
  ModelData data = fallingModes();
  std::fill(data.modes_X.begin(), data.modes_X.end(), 0.0F);
  data.modes_packed = modelfile::packModes(data.modes_X, data.modes_X.size() / 24, {0, 5, 8, 11});
  EXPECT_EQ(data.modes_packed.tiles, 0U);
  const MetaModel model = load(data);
  const std::vector<float> u =
      field(model, model.surface().atNode(model.view().contact_node[0]), Vec3(1e-3, 0.0, 0.0));
  EXPECT_TRUE(std::all_of(u.begin(), u.end(), [](float x) { return std::isfinite(x); }));
}

// A scale of 1 there would take the weights of all other modes.
TEST(StoreMixed, AModeThatMovesNothingHasNoScaleToSpeakOf) {
  ModelData data = fallingModes();
  const std::size_t numbers = data.modes_X.size() / 24;
  std::fill_n(data.modes_X.begin() + static_cast<std::ptrdiff_t>(23 * numbers), numbers, 0.0F);
  data.modes_packed = modelfile::packModes(data.modes_X, numbers, {0, 5, 8, 11});
  EXPECT_EQ(complaint(data), "");
  data.modes_packed.scale[23] = 1.0F;
  EXPECT_THAT(complaint(data), HasSubstr("/modes/scale number 23 is 1, expected at most"));
}

TEST(StoreMixed, MoreModesThanWeightsAllowAreRefused) {
  const std::size_t modes = kMostPackedModes + 1;
  ModelData data = syntheticModel({.subdivisions = 0, .modes = static_cast<int>(modes)});
  data.modes_packed = modelfile::packModes(data.modes_X, data.modes_X.size() / modes, {0, 0, 0, modes});
  EXPECT_THAT(complaint(data),
              HasSubstr("/modes/kinds has 16385 modes in int16 or in bytes, expected at most 16384"));
}

TEST(StoreMixed, AModelWithoutErrorKeepsItsNumbers) {
  ModelData data = fallingModes();
  const ModelData before = data;
  const StorageReport report = modelfile::storeMixed(data, 0.0);
  EXPECT_EQ(report.counts.f32, 24U);
  EXPECT_TRUE(data.modes_packed.view().empty());
  EXPECT_EQ(data.modes_X, before.modes_X);
}

TEST(StoreMixed, FieldsOfEveryKindOfModelAreWhatTheyWere) {
  for (const Parameters kind : {Parameters::kDisplacement, Parameters::kForce, Parameters::kLevel}) {
    ModelData mixed = fallingModes({.subdivisions = 2, .modes = 24, .parameters = kind});
    const MetaModel before = load(mixed);
    const StorageReport report = modelfile::storeMixed(mixed, 1.0);
    ASSERT_FALSE(mixed.modes_packed.view().empty());
    const MetaModel after = load(mixed);
    EXPECT_EQ(after.farField().counts().bits8, report.counts.bits8);
    for (std::size_t m = 0; m < before.view().positions(); m += 7) {
      const ContactPoint s = before.surface().atNode(before.view().contact_node[m]);
      const Vec3 d(1e-3, -2e-3, 1e-3);
      const std::vector<float> exact = field(before, s, d);
      std::vector<float> error = field(after, s, d);
      for (std::size_t i = 0; i < error.size(); ++i) error[i] -= exact[i];
      // Rounding, modes that are left out, and weights that are whole numbers.
      EXPECT_LE(largestNode(error), 1e-3F * std::max(largestNode(exact), static_cast<float>(d.norm())));
    }
  }
}

TEST(StoreMixed, FilesThatSayOtherwiseThanTheirModesAreRefused) {
  const std::vector<std::pair<std::string, std::function<void(ModelData&)>>> cases{
      {"/modes/bytes, of /modes/X number", [](ModelData& d) { d.modes_packed.X8[4 * 5] ^= 0x40; }},
      {"/modes/bytes, of /modes/X number",
       [](ModelData& d) {  // shared by several
         const ModeCounts counts = countModes(d.modes_packed.view(), 24);
         d.modes_packed.X8[counts.ownQuads() * kTile * 4] ^= 0x40;
       }},
      {"/modes/int16, of /modes/X number", [](ModelData& d) { d.modes_packed.X16[3] ^= 0x0400; }},
      {"/modes/scale number 1 is nan", [](ModelData& d) { d.modes_packed.scale[1] = NAN; }},
      {"/modes/scale number 0 is 0, expected more than 0",
       [](ModelData& d) { d.modes_packed.scale[0] = 0.0F; }},
      {", as /modes/X is", [](ModelData& d) { d.modes_packed.scale[0] *= 10.0F; }},
      {", as /modes/X is", [](ModelData& d) { d.modes_packed.scale.back() *= 10.0F; }},
      {"/modes/kinds has -1, expected at least 0", [](ModelData& d) { d.modes_packed.kinds[0] = -1; }},
      {"/modes/kinds adds up to",
       [](ModelData& d) {
         d.modes_packed.kinds[2] += 25;
         d.modes_packed.scale.resize(d.modes_packed.scale.size() + 25, 1.0F);
       }},
      {"/modes/kinds has 2", [](ModelData& d) { d.modes_packed.kinds.pop_back(); }},
      {"/modes/scale has", [](ModelData& d) { d.modes_packed.scale.pop_back(); }},
      {"/modes/int16 has", [](ModelData& d) { d.modes_packed.X16.pop_back(); }},
      {"tiles, expected at most", [](ModelData& d) { resizeTiles(d, +1000); }},
      {"of /modes/X number", [](ModelData& d) { resizeTiles(d, -1); }},
      {"/modes/bytes has", [](ModelData& d) { d.modes_packed.X8.resize(d.modes_packed.X8.size() / 2); }},
  };
  ModelData good = fallingModes();
  const StorageReport report = modelfile::storeMixed(good, 5e-3);
  ASSERT_GT(report.counts.i16, 0U);
  ASSERT_GT(report.counts.bits10, 0U);
  ASSERT_GT(report.counts.inBytes(), 8U);
  EXPECT_EQ(complaint(good), "");
  for (const auto& [expected, spoil] : cases) {
    ModelData data = good;
    spoil(data);
    EXPECT_THAT(complaint(data), HasSubstr(expected));
  }
}

TEST(StoreMixed, FilesWithAPartOfThePackedModesAreRefused) {
  for (const char* dataset : {"modes/int16", "modes/bytes", "modes/scale", "modes/kinds"}) {
    const TemporaryFile file("part.h5");
    ModelData data = fallingModes();
    (void)modelfile::storeMixed(data, 5e-3);
    modelfile::writeModel(file.path(), data);
    {
      const Hdf5Handle opened(H5Fopen(file.path().c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
      ASSERT_GE(H5Ldelete(opened.get(), dataset, H5P_DEFAULT), 0);
    }
    try {
      (void)MetaModel::load(file.path());
      ADD_FAILURE() << "without " << dataset << " it was read";
    } catch (const LoadError& error) {
      EXPECT_THAT(error.what(), HasSubstr(std::string("/") + dataset + " is missing"));
    }
  }
}

/// What loading a file says after one of its datasets was written over or added.
template <typename T>
std::string complaintAbout(const char* dataset, hid_t type, const std::vector<T>& values) {
  const TemporaryFile file("kinds.h5");
  ModelData data = fallingModes();
  (void)modelfile::storeMixed(data, 5e-3);
  modelfile::writeModel(file.path(), data);
  {
    const Hdf5Handle opened(H5Fopen(file.path().c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const hsize_t count = values.size();
    const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
    const bool exists = H5Lexists(opened.get(), dataset, H5P_DEFAULT) > 0;
    const Hdf5Handle written(
        exists ? H5Dopen2(opened.get(), dataset, H5P_DEFAULT)
               : H5Dcreate2(opened.get(), dataset, type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    EXPECT_GE(H5Dwrite(written.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  }
  try {
    (void)MetaModel::load(file.path());
    return {};
  } catch (const LoadError& error) {
    EXPECT_THAT(error.what(), HasSubstr(file.path().string()));
    return error.what();
  }
}

TEST(StoreMixed, MoreTilesThanTheSurfaceHasAreRefused) {
  const TemporaryFile file("tiles.h5");
  ModelData data = fallingModes();
  (void)modelfile::storeMixed(data, 5e-3);
  modelfile::writeModel(file.path(), data);
  const ModeCounts counts = countModes(data.modes_packed.view(), 24);
  {
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    ASSERT_GE(H5Pset_alignment(access.get(), 1, 4096), 0);
    const Hdf5Handle opened(H5Fopen(file.path().c_str(), H5F_ACC_RDWR, access.get()), H5Fclose);
    const auto replace = [&](const char* dataset, hid_t type, std::array<hsize_t, 4> shape) {
      ASSERT_GE(H5Ldelete(opened.get(), dataset, H5P_DEFAULT), 0);
      const Hdf5Handle space(H5Screate_simple(4, shape.data(), nullptr), H5Sclose);
      const Hdf5Handle written(
          H5Dcreate2(opened.get(), dataset, type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
          H5Dclose);
      const std::vector<std::int16_t> none(shape[0] * shape[1] * shape[2] * shape[3]);
      ASSERT_GE(H5Dwrite(written.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, none.data()), 0);
    };
    const hsize_t tiles = tilesOf(data.modes_X.size() / 24) + 1;
    replace("modes/int16", H5T_STD_I16LE, {tiles, counts.pairs(), kTile, 2});
    replace("modes/bytes", H5T_STD_U8LE, {tiles, counts.quads(), kTile, 4});
  }
  try {
    (void)MetaModel::load(file.path());
    ADD_FAILURE() << "it was read";
  } catch (const LoadError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/modes/int16 has tiles = "));
  }
}

TEST(StoreMixed, NegativeAndHugeCountsOfModesAreRefused) {
  const auto kinds = [](std::vector<std::int32_t> values) {
    return complaintAbout("modes/kinds", H5T_NATIVE_INT32, values);
  };
  EXPECT_THAT(kinds({4, -2, 4}), HasSubstr("/modes/kinds number 1 is -2, expected at least 0"));
  EXPECT_THAT(kinds({4, 4, 2000000000}), HasSubstr("/modes/kinds adds up to 2000000008, expected at most"));
  EXPECT_THAT(kinds({2147483647, 2147483647, 2147483647}), HasSubstr("adds up to 6442450941"));
  EXPECT_THAT(kinds({0, 0, 1}), HasSubstr("/modes/scale"));
}

TEST(StoreMixed, FilesOfTheStorageBeforeAreRefusedByName) {
  for (const char* old : {"modes/X16", "modes/X8", "modes/scale16", "modes/scale8"})
    EXPECT_THAT(complaintAbout(old, H5T_NATIVE_FLOAT, std::vector<float>(4, 1.0F)),
                HasSubstr(std::string("/") + old + " is a storage of modes that is no longer read"));
}

}  // namespace palpate::testing
