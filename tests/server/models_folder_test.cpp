// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/models_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/data/load_error.h"
#include "palpate/server/config.h"
#include "palpate/server/config_file.h"
#include "palpate/testing/files.h"

namespace palpate::server {
namespace {

// "models/organ.h5", "models/sub/organ.h5", and a secret beside the folder.
class ModelsFolderTest : public ::testing::Test {
 protected:
  ModelsFolderTest() {
    std::filesystem::create_directories(root_ / "models/sub");
    (void)root_.write("models/organ.h5", "in");
    (void)root_.write("models/sub/organ.h5", "deeper");
    (void)root_.write("secret.h5", "out");
  }

  // What is read by a name; "refused: " and why.
  [[nodiscard]] std::string opened(const std::string& name) const {
    try {
      const ModelsFolder folder(root_ / "models");
      const int file = folder.open(name);
      std::string content(16, '\0');
      content.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::read(file, content.data(), 16))));
      ::close(file);
      return content;
    } catch (const LoadError& error) {
      return std::string("refused: ") + error.what();
    }
  }

  palpate::testing::TemporaryFolder root_;
};

TEST_F(ModelsFolderTest, OpensWhatLiesInIt) {
  EXPECT_EQ(opened("organ.h5"), "in");
  EXPECT_EQ(opened("sub/organ.h5"), "deeper");
  EXPECT_EQ(opened("./sub/../organ.h5").find("refused"), 0U) << "not even a \"..\" that stays within";
}

TEST_F(ModelsFolderTest, OpensNothingElse) {
  EXPECT_EQ(
      opened("../secret.h5"),
      "refused: model \"../secret.h5\" holds \"..\", expected a path within the server's folder of models");
  EXPECT_EQ(opened((root_ / "secret.h5").string()).find("refused: model \"/"), 0U);
  EXPECT_NE(opened((root_ / "models/organ.h5").string()).find("is no path relative to"), std::string::npos)
      << "not even one that leads into it";
  EXPECT_NE(opened("").find("is no path relative to"), std::string::npos);
  EXPECT_NE(opened("a\nb").find("\"a?b\" holds a character that is not printable"), std::string::npos);
  EXPECT_EQ(opened("none.h5"), "refused: model \"none.h5\" is not in the server's folder of models");
  EXPECT_EQ(opened("organ.h5/x"), "refused: model \"organ.h5/x\" is not in the server's folder of models");
}

TEST_F(ModelsFolderTest, FollowsLinksWithinItOnly) {
  std::filesystem::create_symlink("organ.h5", root_ / "models/current.h5");
  std::filesystem::create_symlink("../organ.h5", root_ / "models/sub/up.h5");
  std::filesystem::create_symlink("../secret.h5", root_ / "models/out.h5");
  std::filesystem::create_symlink(root_ / "secret.h5", root_ / "models/absolute.h5");
  std::filesystem::create_directory_symlink("..", root_ / "models/parent");
  std::filesystem::create_symlink("/proc/self/fd", root_ / "models/fd");
  EXPECT_EQ(opened("current.h5"), "in");
  EXPECT_EQ(opened("sub/up.h5"), "in");
  for (const char* name : {"out.h5", "absolute.h5", "parent/secret.h5", "fd/0"})
    EXPECT_EQ(opened(name),
              std::string("refused: model \"") + name + "\" leads out of the server's folder of models");
}

TEST_F(ModelsFolderTest, IsThatOfTheStartWhateverItsNameIsLater) {
  const ModelsFolder folder(root_ / "models");
  std::filesystem::rename(root_ / "models", root_ / "moved");
  std::filesystem::create_symlink(root_.path(), root_ / "models");
  EXPECT_THROW((void)folder.open("secret.h5"), LoadError);
  const int file = folder.open("organ.h5");
  EXPECT_GE(file, 0);
  ::close(file);
}

TEST_F(ModelsFolderTest, APipeInItDoesNotBlock) {
  ASSERT_EQ(::mkfifo((root_ / "models/pipe").c_str(), 0600), 0);
  EXPECT_EQ(opened("pipe"), "");
}

TEST(ModelsFolder, HasToBeAFolder) {
  const palpate::testing::TemporaryFolder root;
  (void)root.write("file", "x");
  EXPECT_THROW(ModelsFolder{root / "none"}, ConfigError);
  EXPECT_THROW(ModelsFolder{root / "file"}, ConfigError);
}

TEST(ModelsFolder, IsTakenFromTheFolderOfTheConfiguration) {
  const palpate::testing::TemporaryFolder root;
  ServerConfig config;
  readConfigFile(root.write("server.toml", "models = \"organs\"\n"), config);
  EXPECT_EQ(config.models, root / "organs");
  EXPECT_THROW(readConfigFile(root.write("empty.toml", "models = \"\"\n"), config), ConfigError);
}

}  // namespace
}  // namespace palpate::server
