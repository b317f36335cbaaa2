// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/output.h"

#include <gtest/gtest.h>

#include <string>

#include "palpate/testing/files.h"

namespace palpate::reproduce {
namespace {

TEST(OutputFolder, IsMadeAndHoldsWhatIsWritten) {
  const palpate::testing::TemporaryFolder folder;
  const Output out(folder / "a" / "b", true);
  out.writeCsv("errors.csv", {"dt", "error"}, {{0.1, 1e-3}, {0.01, 1e-5}});
  EXPECT_EQ(palpate::testing::contentOf(folder / "a" / "b" / "errors.csv"),
            "dt,error\n0.1,0.001\n0.01,1e-05\n");
}

TEST(OutputFolder, ThatIsAFileIsRefusedByName) {
  const palpate::testing::TemporaryFolder folder;
  folder.write("file", "x");
  try {
    const Output out(folder / "file", true);
    FAIL() << "took a file for a folder";
  } catch (const ReproduceError& error) {
    EXPECT_NE(std::string(error.what()).find("file"), std::string::npos);
  }
}

}  // namespace
}  // namespace palpate::reproduce
