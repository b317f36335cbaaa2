// SPDX-License-Identifier: Apache-2.0
// A model file that was changed after it was written.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <span>
#include <string_view>

#include "../load_case.h"
#include "core/data/model_content.h"

namespace palpate::testing {

namespace {

using modelfile::ModelData;

std::vector<std::string> datasetsOf(hid_t file) {
  std::vector<std::string> names;
  const auto keep = [](hid_t group, const char* name, const H5L_info_t*, void* list) -> herr_t {
    H5O_info_t info{};
    if (H5Oget_info_by_name2(group, name, &info, H5O_INFO_BASIC, H5P_DEFAULT) >= 0 &&
        info.type == H5O_TYPE_DATASET)
      static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, keep, &names);
  return names;
}

std::vector<std::string> attributesOf(hid_t file) {
  std::vector<std::string> names;
  const auto keep = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  H5Aiterate2(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, keep, &names);
  return names;
}

/// Flips the lowest bit of the number in the middle. @return false where there are no numbers
bool flipInDataset(hid_t file, const std::string& name) {
  const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle type(H5Dget_type(dataset.get()), H5Tclose);
  const std::size_t width = H5Tget_size(type.get());
  std::vector<unsigned char> bytes(static_cast<std::size_t>(H5Dget_storage_size(dataset.get())));
  if (bytes.empty()) return false;
  H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
  bytes[bytes.size() / width / 2 * width] ^= 1U;
  return H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) >= 0;
}

bool flipInAttribute(hid_t file, const std::string& name) {
  const Hdf5Handle attribute(H5Aopen(file, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose);
  if (H5Tis_variable_str(type.get()) > 0) {
    char* text = nullptr;
    H5Aread(attribute.get(), type.get(), &text);
    std::string changed = text;
    H5free_memory(text);
    changed.back() = static_cast<char>(changed.back() ^ 1);
    const char* const start = changed.c_str();
    return H5Awrite(attribute.get(), type.get(), &start) >= 0;
  }
  std::vector<unsigned char> bytes(static_cast<std::size_t>(H5Aget_storage_size(attribute.get())));
  H5Aread(attribute.get(), type.get(), bytes.data());
  bytes.front() ^= 1U;
  return H5Awrite(attribute.get(), type.get(), bytes.data()) >= 0;
}

/// Writes the numbers of /contact/force in place, multiplied.
void writeForce(const std::filesystem::path& path, double factor) {
  const Hdf5Handle file = openForSpoiling(path);
  const Hdf5Handle dataset(H5Dopen2(file.get(), "contact/force", H5P_DEFAULT), H5Dclose);
  std::vector<double> force = goodData().contact_force;
  for (double& number : force) number *= factor;
  H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, force.data());
}

/// One of each kind.
std::vector<ModelData> models() {
  return {goodData(Parameters::kDisplacement), goodData(Parameters::kForce), goodData(Parameters::kLevel)};
}

std::string idOf(const ModelData& data) {
  const TemporaryFile file("id.h5");
  modelfile::writeModel(file.path(), data);
  return MetaModel::load(file.path()).id();
}

/// Names of the datasets that a source file gives to a call. @param call  its name
std::set<std::string> datasetsNamed(const std::string& file, const std::string& call) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  std::ifstream in(std::filesystem::path(PALPATE_CORE_DIR) / file);
  const std::string source{std::istreambuf_iterator<char>(in), {}}, before = call + "(dataset::";
  std::set<std::string> names;
  for (std::size_t at = source.find(before); at != std::string::npos; at = source.find(before, at)) {
    at += before.size();
    names.insert(source.substr(at, source.find_first_not_of(kLetters, at) - at));
  }
  return names;
}

}  // namespace

TEST(Digest, AFlippedBitInAnyDatasetOrAttributeIsRefused) {
  int flipped = 0;
  for (const ModelData& data : models()) {
    const TemporaryFile file("flipped.h5");
    modelfile::writeModel(file.path(), data);
    const auto names = [&](auto list) { return list(openForSpoiling(file.path()).get()); };
    const auto expectNoticed = [&](const std::string& name, auto flip) {
      modelfile::writeModel(file.path(), data);
      if (!flip(openForSpoiling(file.path()).get(), name)) return;
      EXPECT_NE(complaint(file.path()), "") << name;
      ++flipped;
    };
    for (const std::string& name : names(datasetsOf)) expectNoticed(name, flipInDataset);
    for (const std::string& name : names(attributesOf)) expectNoticed(name, flipInAttribute);
  }
  EXPECT_GT(flipped, 3 * 30);
}

TEST(Digest, IsOfEveryDatasetThatIsRead) {
  std::set<std::string> read = datasetsNamed("data/model_reader.cpp", "file.dataset");
  read.merge(datasetsNamed("data/model_reader.cpp", "file.wholeNumbers"));
  EXPECT_GT(read.size(), 20U);
  EXPECT_EQ(read, datasetsNamed("data/model_content.h", "visit"));
}

TEST(Digest, AForceThatIsThreeTimesAsLargeIsNotServed) {
  const TemporaryFile file("three.h5");
  modelfile::writeModel(file.path(), goodData());
  const std::string digest = MetaModel::load(file.path()).digest().hex();
  writeForce(file.path(), 3.0);
  const std::string text = complaint(file.path());
  EXPECT_THAT(text, ::testing::HasSubstr(file.path().string() + ": the digest of its content is "));
  EXPECT_THAT(text, ::testing::HasSubstr("the file says " + digest));
  writeForce(file.path(), 1.0);
  EXPECT_EQ(complaint(file.path()), "") << "the same numbers are the same content";
}

TEST(Digest, TheSameContentHasTheSameIdAndAnotherHasAnother) {
  const std::string id = idOf(goodData());
  EXPECT_EQ(id.size(), 40U);
  ModelData data = goodData();
  data.attributes.provenance = R"({"program": "another day"})";
  EXPECT_EQ(idOf(data), id);
  data.contact_force[5] = std::nextafter(data.contact_force[5], 1.0);
  EXPECT_NE(idOf(data), id);
  data = goodData();
  data.attributes.nu = std::nextafter(data.attributes.nu, 0.0);
  EXPECT_NE(idOf(data), id);
}

TEST(Digest, TheNumberOnTheWireIsTheBeginningOfTheId) {
  const TemporaryFile file("hash.h5");
  modelfile::writeModel(file.path(), goodData());
  const MetaModel model = MetaModel::load(file.path());
  std::uint64_t leading = 0;
  const std::string digits = model.id().substr(0, 16);
  std::from_chars(digits.data(), digits.data() + digits.size(), leading, 16);
  EXPECT_EQ(model.contentHash(), leading);
  EXPECT_EQ(model.digest().hex().substr(0, 40), model.id());
}

TEST(Digest, IsThatOfTheStandard) {  // FIPS 180-2, B.1
  EXPECT_EQ(sha256(std::as_bytes(std::span("abc", 3))).hex(),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Digest, AFileWithoutOneIsRefused) {
  for (const char* attribute : {"digest", "provenance_digest"}) {
    const TemporaryFile file("undigested.h5");
    modelfile::writeModel(file.path(), goodData());
    deleteThing(file.path(), attribute, nullptr);
    expectRefused(file.path(), std::string("attribute ") + attribute + " is missing");
  }
}

}  // namespace palpate::testing
