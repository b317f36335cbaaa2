// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <functional>

#include "palpate/core/hdf5_handle.h"
#include "palpate/core/load_error.h"
#include "palpate/core/meta_model.h"
#include "palpate/core/response.h"
#include "palpate/modelfile/mixed_precision.h"
#include "palpate/modelfile/model_file.h"
#include "palpate/testing/synthetic_model.h"

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
    EXPECT_EQ(report.counts.f32 + report.counts.i16 + report.counts.i8, 24U);
  }
}

TEST(StoreMixed, FewerBitsWhereMoreErrorIsAllowed) {
  ModelData strict = fallingModes(), loose = fallingModes();
  const StorageReport few = modelfile::storeMixed(loose, 1.0), many = modelfile::storeMixed(strict, 2e-4);
  EXPECT_LT(few.bytes, many.bytes);
  EXPECT_GT(few.counts.i8, many.counts.i8);
  EXPECT_LT(many.bytes, sizeof(float) * strict.modes_X.size());
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
    EXPECT_EQ(after.farField().counts().i8, report.counts.i8);
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
      {"/modes/X8, of /modes/X number", [](ModelData& d) { d.modes_packed.X8[4 * 5] ^= 0x40; }},
      {"/modes/X16, of /modes/X number", [](ModelData& d) { d.modes_packed.X16[3] ^= 0x0400; }},
      {"/modes/scale8 number 1 is nan", [](ModelData& d) { d.modes_packed.scale8[1] = NAN; }},
      {"/modes/scale16 number 0 is 0, expected more than 0",
       [](ModelData& d) { d.modes_packed.scale16[0] = 0.0F; }},
      {"/modes/scale16 and scale8 have", [](ModelData& d) { d.modes_packed.scale8.resize(25, 1.0F); }},
      {"/modes/X16 has", [](ModelData& d) { d.modes_packed.X16.pop_back(); }},
      {"/modes/X8 has", [](ModelData& d) { d.modes_packed.X8.resize(d.modes_packed.X8.size() / 2); }},
  };
  ModelData good = fallingModes();
  const StorageReport report = modelfile::storeMixed(good, 5e-3);
  ASSERT_GT(report.counts.i16, 0U);
  ASSERT_GT(report.counts.i8, 8U);
  EXPECT_EQ(complaint(good), "");
  for (const auto& [expected, spoil] : cases) {
    ModelData data = good;
    spoil(data);
    EXPECT_THAT(complaint(data), HasSubstr(expected));
  }
}

TEST(StoreMixed, FilesWithAPartOfThePackedModesAreRefused) {
  for (const char* dataset : {"modes/X16", "modes/X8", "modes/scale16", "modes/scale8"}) {
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

}  // namespace palpate::testing
