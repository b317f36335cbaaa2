// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/write_certificate.h"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/data/hdf5_handle.h"
#include "core/model/meta_model.h"
#include "palpate/testing/synthetic_model.h"
#include "tools/modelfile/write_model.h"

namespace palpate::testing {

namespace {

constexpr const char* kText = R"({"samples": 59})";

class WriteCertificate : public ::testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::filesystem::path path_{folder_ / "model.h5"};
  const MetaModel model_{written()};

  [[nodiscard]] MetaModel written() const {
    writeSyntheticModel(path_, {.subdivisions = 1, .modes = 2});
    return MetaModel::load(path_);
  }
  [[nodiscard]] std::size_t filesBeside() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_.path()),
                                                  std::filesystem::directory_iterator()));
  }
};

}  // namespace

TEST_F(WriteCertificate, ComesBackAndTheModelStaysTheSame) {
  modelfile::writeCertificate(path_, kText, model_.digest());
  const MetaModel certified = MetaModel::load(path_);
  EXPECT_EQ(certified.attributes().certificate, kText);
  EXPECT_EQ(certified.digest(), model_.digest());
  EXPECT_EQ(certified.attributes().provenance, model_.attributes().provenance);
  EXPECT_EQ(filesBeside(), 1U);
}

TEST_F(WriteCertificate, NumbersAreStoredAsBefore) {
  constexpr double kMost = 16384.0;  // bytes that a certificate may take, with what HDF5 keeps about it
  modelfile::ModelData data = syntheticModel({.subdivisions = 3, .modes = 8});
  std::vector<double> sizes;
  for (const bool compact : {false, true}) {
    data.compact = compact;
    modelfile::writeModel(path_, data);
    sizes.push_back(static_cast<double>(std::filesystem::file_size(path_)));
    const Digest digest = MetaModel::load(path_).digest();
    modelfile::writeCertificate(path_, kText, digest);
    EXPECT_NEAR(static_cast<double>(std::filesystem::file_size(path_)), sizes.back(), kMost);
    EXPECT_EQ(MetaModel::load(path_).digest(), digest);
  }
  EXPECT_GT(sizes[0] - sizes[1], 2.0 * kMost) << "else a file written the other way would not show";
}

// HDF5 opens nothing here that another program made.
TEST_F(WriteCertificate, WhatElseLayInTheFileIsGone) {
  {
    const Hdf5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const Hdf5Handle group(H5Gcreate2(file.get(), "of_a_stranger", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                           H5Gclose);
    ASSERT_TRUE(group.valid());
  }
  ASSERT_NE(contentOf(path_).find("of_a_stranger"), std::string::npos);
  modelfile::writeCertificate(path_, kText, model_.digest());
  EXPECT_EQ(contentOf(path_).find("of_a_stranger"), std::string::npos);
  EXPECT_EQ(MetaModel::load(path_).attributes().certificate, kText);
}

TEST_F(WriteCertificate, TakesThePlaceOfTheOneBefore) {
  modelfile::writeCertificate(path_, kText, model_.digest());
  const auto size = std::filesystem::file_size(path_);
  const std::string other = R"({"samples": 93, "note": ")" + std::string(60'000, 'x') + R"("})";
  modelfile::writeCertificate(path_, other, model_.digest());
  EXPECT_EQ(MetaModel::load(path_).attributes().certificate, other);
  for (int again = 0; again < 5; ++again) modelfile::writeCertificate(path_, kText, model_.digest());
  EXPECT_EQ(MetaModel::load(path_).attributes().certificate, kText);
  EXPECT_LT(std::filesystem::file_size(path_), size + 5 * 16384 + 2 * other.size());
}

TEST_F(WriteCertificate, WhoHasTheFileOpenKeepsTheOldOne) {
  const std::string before = contentOf(path_);
  std::ifstream open(path_, std::ios::binary);
  modelfile::writeCertificate(path_, kText, model_.digest());
  EXPECT_TRUE(std::string(std::istreambuf_iterator<char>(open), {}) == before);
  EXPECT_TRUE(contentOf(path_) != before);
}

TEST_F(WriteCertificate, RefusesAFileWhoseContentIsAnother) {
  writeSyntheticModel(folder_ / "other.h5", {.subdivisions = 1, .modes = 2, .stiffness = 301.0});
  const MetaModel other = MetaModel::load(folder_ / "other.h5");
  const std::string before = contentOf(path_);
  try {
    modelfile::writeCertificate(path_, kText, other.digest());
    FAIL() << "a certificate of another model was written";
  } catch (const modelfile::ModelFileError& error) {
    EXPECT_EQ(std::string(error.what()).rfind(path_.string() + ": not certified: ", 0), 0U) << error.what();
    EXPECT_NE(std::string(error.what())
                  .find("the certificate belongs to the content " + other.digest().hex() +
                        ", the digest of this content is " + model_.digest().hex()),
              std::string::npos)
        << error.what();
  }
  EXPECT_TRUE(contentOf(path_) == before);
  EXPECT_EQ(filesBeside(), 2U);
}

TEST_F(WriteCertificate, AFlippedByteOfTheCertifiedModelIsRefused) {
  modelfile::writeCertificate(path_, kText, model_.digest());
  std::string bytes = contentOf(path_);
  const auto nodes = std::as_bytes(model_.view().mesh_nodes);
  const std::size_t at = bytes.find(std::string(reinterpret_cast<const char*>(nodes.data()), nodes.size()));
  ASSERT_NE(at, std::string::npos);
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  std::ofstream(path_, std::ios::binary) << bytes;
  EXPECT_THROW((void)MetaModel::load(path_), LoadError);
}

TEST_F(WriteCertificate, ASymbolicLinkStaysOne) {
  const auto link = folder_ / "link.h5";
  std::filesystem::create_symlink(path_, link);
  modelfile::writeCertificate(link, kText, model_.digest());
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(MetaModel::load(path_).attributes().certificate, kText);
}

TEST_F(WriteCertificate, WhatAnEarlierProcessLeftIsOverwritten) {
  std::ofstream(path_.string() + ".tmp-" + std::to_string(getpid())) << "half a file";
  modelfile::writeCertificate(path_, kText, model_.digest());
  EXPECT_EQ(MetaModel::load(path_).attributes().certificate, kText);
  EXPECT_EQ(filesBeside(), 1U);
}

TEST_F(WriteCertificate, AReadOnlyFileIsCertifiedAndStaysReadOnly) {
  using std::filesystem::perms;
  const perms read_only = perms::owner_read | perms::group_read | perms::others_read;
  std::filesystem::permissions(path_, read_only);
  modelfile::writeCertificate(path_, kText, model_.digest());
  EXPECT_EQ(std::filesystem::status(path_).permissions(), read_only);
  EXPECT_EQ(MetaModel::load(path_).attributes().certificate, kText);
}

TEST_F(WriteCertificate, SaysWhatCannotBeWritten) {
  const auto missing = folder_ / "missing.h5";
  try {
    modelfile::writeCertificate(missing, kText, model_.digest());
    FAIL() << "no error";
  } catch (const modelfile::ModelFileError& error) {
    EXPECT_EQ(error.what(), missing.string() + ": cannot be written: No such file or directory");
  }
}

}  // namespace palpate::testing
