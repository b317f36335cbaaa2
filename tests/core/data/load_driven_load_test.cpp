// SPDX-License-Identifier: Apache-2.0
// Every way in which a file of a load-driven model can be wrong.
#include <algorithm>
#include <functional>
#include <limits>

#include "../load_case.h"
#include "../spoiled_file.h"
#include "palpate/testing/synthetic_model.h"
#include "tools/modelfile/write_model.h"

#if defined(__SANITIZE_ADDRESS__)
/// HDF5 1.10.8 itself leaks a few hundred bytes on some files that it refuses.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libhdf5";
}
#endif

namespace palpate::testing {

namespace {

using modelfile::ModelData;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

struct WrongData {
  std::string name;
  Parameters parameters;
  std::string expected;
  std::function<void(ModelData&)> spoil;
};

struct WrongFile {
  std::string name;
  Parameters parameters;
  std::string expected;
  std::function<void(const std::filesystem::path&)> spoil;
};

void setVector(const std::filesystem::path& path, const char* name, std::vector<double> values) {
  const Hdf5Handle file = openForSpoiling(path);
  H5Adelete(file.get(), name);
  const hsize_t count = values.size();
  const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Hdf5Handle attribute(
      H5Acreate2(file.get(), name, H5T_NATIVE_DOUBLE, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, values.data());
}

void setText(const std::filesystem::path& path, const char* name, const std::string& text) {
  const Hdf5Handle file = openForSpoiling(path);
  H5Adelete(file.get(), name);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), text.size());
  const Hdf5Handle attribute(H5Acreate2(file.get(), name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  H5Awrite(attribute.get(), type.get(), text.data());
}

/// Puts numbers of another type or shape in the place of a dataset.
void replaceWith(const std::filesystem::path& path, const char* dataset, hid_t type,
                 const std::vector<hsize_t>& shape) {
  const Hdf5Handle file = openForSpoiling(path);
  H5Lmove(file.get(), dataset, file.get(), "old", H5P_DEFAULT, H5P_DEFAULT);
  const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY);
  const Hdf5Handle data(
      H5Dcreate2(file.get(), dataset, type, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Dclose);
  ASSERT_TRUE(data.valid());
}

/// Lets e . d(s, t) of position m rise up to level 0.6 and then fall; the other positions rise on.
void turnBack(ModelData& d, std::size_t m) {
  const std::size_t points = d.levels_Z.size() / 3;  // 3 functions, steps of 0.1
  for (std::size_t j = 0; j < points; ++j) d.levels_Z[points + j] = j <= 6 ? 0.0 : -0.2 * double(j - 6);
  for (std::size_t i = 0; i < d.contact_displacement.size(); i += 9)
    std::fill_n(d.contact_displacement.begin() + static_cast<std::ptrdiff_t>(i + 3), 6, 0.0);
  std::copy_n(d.contact_displacement.begin() + static_cast<std::ptrdiff_t>(9 * m), 3,
              d.contact_displacement.begin() + static_cast<std::ptrdiff_t>(9 * m + 3));
}

/// Level functions and all that has one row for each, of another number.
void setLevelFunctions(const std::filesystem::path& path, hsize_t functions) {
  const hsize_t M = goodData(Parameters::kLevel).contact_node.size();
  replaceWith(path, "levels/Z", H5T_IEEE_F64LE, {functions, 11});
  deleteThing(path, nullptr, "old");
  replaceWith(path, "contact/displacement", H5T_IEEE_F64LE, {M, functions, 3});
  deleteThing(path, nullptr, "old");
  replaceWith(path, "modes/Y", H5T_STD_I16LE, {M, functions, 2});
}

}  // namespace

class LoadDrivenRefuses : public ::testing::TestWithParam<WrongData> {};

TEST_P(LoadDrivenRefuses, WithOneClearLine) {
  ModelData data = goodData(GetParam().parameters);
  GetParam().spoil(data);
  const TemporaryFile file("load-driven-numbers.h5");
  modelfile::writeModel(file.path(), data);
  expectRefused(file.path(), GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    All, LoadDrivenRefuses,
    ::testing::Values(
        WrongData{"ReferenceForce", Parameters::kForce,
                  "attribute reference_force is 0, expected more than 0 N",
                  [](ModelData& d) { d.attributes.reference_force = 0.0; }},
        WrongData{"NanReferenceForce", Parameters::kForce, "attribute reference_force is nan",
                  [](ModelData& d) { d.attributes.reference_force = kNotANumber; }},
        WrongData{"Load", Parameters::kLevel, "attribute load is -1, expected more than 0 N",
                  [](ModelData& d) { d.attributes.load = -1.0; }},
        WrongData{"Direction", Parameters::kLevel, "attribute load_direction has length 2, expected 1",
                  [](ModelData& d) {
                    d.attributes.load_direction = {0.0, 0.0, 2.0};
                  }},
        WrongData{"NanDirection", Parameters::kLevel, "attribute load_direction has length nan, expected 1",
                  [](ModelData& d) { d.attributes.load_direction[1] = kNotANumber; }},
        WrongData{"InfiniteDisplacement", Parameters::kForce,
                  "/contact/displacement number 4 is inf, expected a finite number",
                  [](ModelData& d) { d.contact_displacement[4] = std::numeric_limits<double>::infinity(); }},
        WrongData{"NanDisplacement", Parameters::kLevel, "/contact/displacement number 4 is nan",
                  [](ModelData& d) { d.contact_displacement[4] = kNotANumber; }},
        WrongData{"NoDomain", Parameters::kForce,
                  "/contact/domain_radius number 3 is 0, expected more than 0 N",
                  [](ModelData& d) { d.contact_domain_radius[3] = 0.0; }},
        WrongData{"DomainBelowLevels", Parameters::kLevel,
                  "/contact/domain_radius number 3 is 0, expected more than 0, at most 1",
                  [](ModelData& d) { d.contact_domain_radius[3] = 0.0; }},
        WrongData{"DomainAboveLevels", Parameters::kLevel,
                  "/contact/domain_radius number 3 is 1.5, expected more than 0, at most 1",
                  [](ModelData& d) { d.contact_domain_radius[3] = 1.5; }},
        WrongData{"LevelFunctionAtRest", Parameters::kLevel,
                  "/levels/Z number 11 is 0.25, expected 0 at level 0",
                  [](ModelData& d) { d.levels_Z[11] = 0.25; }},
        WrongData{"NanLevelFunction", Parameters::kLevel, "/levels/Z number 7 is nan",
                  [](ModelData& d) { d.levels_Z[7] = kNotANumber; }},
        WrongData{"DirectionByTheLastBits", Parameters::kLevel,
                  "attribute load_direction has length 1.0000001, expected 1",
                  [](ModelData& d) {
                    d.attributes.load_direction = {0.0, 0.0, 1.0000001};
                  }},
        WrongData{"LoadThatPulls", Parameters::kLevel,
                  "/contact/displacement number 5 along the load goes from 0 m to -0.",
                  [](ModelData& d) {
                    for (std::size_t i = 5 * 9; i < 6 * 9; ++i) d.contact_displacement[i] *= -1.0;
                  }},
        WrongData{"DisplacementTurnsBack", Parameters::kLevel,
                  " m between the levels 0.6 and 0.7, expected to rise up to t_max = 0.65",
                  [](ModelData& d) {
                    d.contact_domain_radius[7] = 0.65;
                    turnBack(d, 7);
                  }},
        WrongData{"TooManyLevels", Parameters::kLevel, "/levels/Z has 100002 levels, expected 2 to 100001",
                  [](ModelData& d) { d.levels_Z.assign(3 * 100'002, 0.0); }},
        WrongData{"NearRadius", Parameters::kForce,
                  "attribute near_radius is 0.01, expected none: a model with parameters \"force\" has no "
                  "near field",
                  [](ModelData& d) { d.attributes.near_radius = 0.01; }},
        WrongData{"NearNodes", Parameters::kLevel, "/near/node has 1 numbers, expected none: a model with",
                  [](ModelData& d) {
                    d.near_node = {0};
                    d.near_field.assign(9, 0.0F);
                    d.near_offset.back() = 1;
                  }}),
    kCaseName);

class LoadDrivenRefusesFile : public ::testing::TestWithParam<WrongFile> {};

TEST_P(LoadDrivenRefusesFile, WithOneClearLine) {
  const TemporaryFile file("load-driven-layout.h5");
  modelfile::writeModel(file.path(), goodData(GetParam().parameters));
  ASSERT_EQ(complaint(file.path()), "");
  GetParam().spoil(file.path());
  expectRefused(file.path(), GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    All, LoadDrivenRefusesFile,
    ::testing::Values(
        WrongFile{"UnknownKind", Parameters::kForce,
                  "attribute parameters is \"torque\", expected \"displacement\", \"force\" or \"level\"",
                  [](const auto& p) { setText(p, "parameters", "torque"); }},
        WrongFile{"ReadAsDisplacement", Parameters::kForce, "/contact/force is missing",
                  [](const auto& p) { setText(p, "parameters", "displacement"); }},
        WrongFile{"KindIsNoText", Parameters::kForce, "attribute parameters is no readable text",
                  [](const auto& p) { setNumber(p, "parameters", H5T_NATIVE_INT, 1); }},
        WrongFile{"NoForceOrder", Parameters::kForce, "attribute force_order is missing",
                  [](const auto& p) { deleteThing(p, "force_order", nullptr); }},
        WrongFile{"ForceOrder", Parameters::kForce, "attribute force_order is 4, expected 3",
                  [](const auto& p) { setNumber(p, "force_order", H5T_NATIVE_INT, 4); }},
        WrongFile{"Order", Parameters::kForce, "attribute order is 8, expected 1 to 7",
                  [](const auto& p) { setNumber(p, "order", H5T_NATIVE_INT, 8); }},
        WrongFile{"NoReferenceForce", Parameters::kForce, "attribute reference_force is missing",
                  [](const auto& p) { deleteThing(p, "reference_force", nullptr); }},
        WrongFile{"ReferenceForceIsNoFloat", Parameters::kForce,
                  "attribute reference_force is little-endian 32-bit integer, expected a float",
                  [](const auto& p) { setNumber(p, "reference_force", H5T_NATIVE_INT, 1); }},
        WrongFile{"NoLoad", Parameters::kLevel, "attribute load is missing",
                  [](const auto& p) { deleteThing(p, "load", nullptr); }},
        WrongFile{"DirectionOfTwo", Parameters::kLevel, "attribute load_direction is not 3 values",
                  [](const auto& p) {
                    setVector(p, "load_direction", {0.0, 1.0});
                  }},
        WrongFile{"DirectionIsANumber", Parameters::kLevel, "attribute load_direction is not 3 values",
                  [](const auto& p) { setNumber(p, "load_direction", H5T_NATIVE_DOUBLE, 1.0); }},
        WrongFile{"NoLevels", Parameters::kLevel, "/levels is missing",
                  [](const auto& p) { deleteThing(p, nullptr, "levels"); }},
        WrongFile{"LevelsInWholeNumbers", Parameters::kLevel,
                  "/levels/Z is little-endian 32-bit integer, expected little-endian 64-bit float",
                  [](const auto& p) {
                    replaceWith(p, "levels/Z", H5T_STD_I32LE, {3, 11});
                  }},
        WrongFile{"LevelsOfRankOne", Parameters::kLevel, "/levels/Z has shape 33, expected C x L + 1",
                  [](const auto& p) { replaceWith(p, "levels/Z", H5T_IEEE_F64LE, {33}); }},
        WrongFile{"OneLevelFunctionTooMany", Parameters::kLevel, "x 3 x 3, expected M = ",
                  [](const auto& p) {
                    replaceWith(p, "levels/Z", H5T_IEEE_F64LE, {4, 11});
                  }},
        WrongFile{"OneLevel", Parameters::kLevel, "/levels/Z has 1 levels, expected 2 to 100001",
                  [](const auto& p) {
                    replaceWith(p, "levels/Z", H5T_IEEE_F64LE, {3, 1});
                  }},
        WrongFile{"NoLevelFunction", Parameters::kLevel, "/levels/Z has 0 level functions, expected 1 to 119",
                  [](const auto& p) { setLevelFunctions(p, 0); }},
        WrongFile{"TooManyLevelFunctions", Parameters::kLevel,
                  "/levels/Z has 120 level functions, expected 1 to 119",
                  [](const auto& p) { setLevelFunctions(p, 120); }},
        WrongFile{"NoLevelAtAll", Parameters::kLevel, "/levels/Z has 0 levels, expected 2 to 100001",
                  [](const auto& p) {
                    replaceWith(p, "levels/Z", H5T_IEEE_F64LE, {3, 0});
                  }},
        WrongFile{"NoDisplacement", Parameters::kForce, "/contact/displacement is missing",
                  [](const auto& p) { deleteThing(p, nullptr, "contact/displacement"); }}),
    kCaseName);

TEST(LoadDriven, DisplacementMayTurnBackAboveTheDomain) {
  const TemporaryFile file("load-driven-turn.h5");
  ModelData data = goodData(Parameters::kLevel);
  data.contact_domain_radius[7] = std::nextafter(0.6, 1.0);  // still the level before
  turnBack(data, 7);
  modelfile::writeModel(file.path(), data);
  EXPECT_EQ(complaint(file.path()), "");
}

}  // namespace palpate::testing
