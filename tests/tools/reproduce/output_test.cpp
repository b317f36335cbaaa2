// SPDX-License-Identifier: Apache-2.0
#include "palpate/reproduce/output.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>

namespace palpate::reproduce {
namespace {

namespace fs = std::filesystem;

class OutputFolder : public ::testing::Test {
 protected:
  ~OutputFolder() override { fs::remove_all(folder_); }
  const fs::path folder_ = fs::temp_directory_path() / ("palpate_output_test_" + std::to_string(getpid()));
};

TEST_F(OutputFolder, IsMadeAndHoldsWhatIsWritten) {
  const Output out(folder_ / "a" / "b", true);
  out.writeCsv("errors.csv", {"dt", "error"}, {{0.1, 1e-3}, {0.01, 1e-5}});
  std::ifstream file(folder_ / "a" / "b" / "errors.csv");
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), "dt,error\n0.1,0.001\n0.01,1e-05\n");
}

TEST_F(OutputFolder, ThatIsAFileIsRefusedByName) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "file") << "x";
  try {
    const Output out(folder_ / "file", true);
    FAIL() << "took a file for a folder";
  } catch (const ReproduceError& error) {
    EXPECT_NE(std::string(error.what()).find("file"), std::string::npos);
  }
}

}  // namespace
}  // namespace palpate::reproduce
