// SPDX-License-Identifier: Apache-2.0
#include "tools/program/installed.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace palpate::program {
namespace {

TEST(Installed, NamesWhatLiesBesideTheProgram) {
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  const std::string from_bin =
      "../" + self.parent_path().filename().string() + "/" + self.filename().string();
  EXPECT_EQ(installedText(from_bin), self.string());
}

TEST(Installed, InABuildNamesThePrefix) {
  EXPECT_EQ(installedText("../etc/palpate/none.toml"),
            "PREFIX/etc/palpate/none.toml where palpate is installed");
  EXPECT_EQ(installedText("/etc/palpate/none.toml"), "/etc/palpate/none.toml") << "what a package says";
}

}  // namespace
}  // namespace palpate::program
