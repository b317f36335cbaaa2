// SPDX-License-Identifier: Apache-2.0
// Files that the viewer serves, and files that it refuses.
#include "page_files.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "palpate/client/error.h"
#include "palpate/testing/files.h"

namespace palpate::viewer {
namespace fs = std::filesystem;
namespace {

class PageFolder : public ::testing::Test {
 protected:
  PageFolder() {
    fs::create_directories(base_ / "page" / "assets");
    write("secret.txt");
    write("page/index.html");
    write("page/.hidden");
    write("page/assets/index-1a2b.js");
    fs::create_symlink(base_ / "secret.txt", base_ / "page" / "link.txt");
    fs::create_directories(base_ / "page-of-another");
    write("page-of-another/file.txt");
  }

  void write(const std::string& name) { base_.write(name, name); }

  const testing::TemporaryFolder base_;
};

TEST_F(PageFolder, ItsFilesHaveTheirTypes) {
  const PageFiles files(base_ / "page");
  ASSERT_TRUE(files.find("/").has_value());
  EXPECT_EQ(files.find("/")->path.filename(), "index.html");
  EXPECT_STREQ(files.find("/index.html")->type, "text/html; charset=utf-8");
  EXPECT_STREQ(files.find("/index.html")->cache, "no-cache");
  ASSERT_TRUE(files.find("/assets/index-1a2b.js").has_value());
  EXPECT_STREQ(files.find("/assets/index-1a2b.js")->type, "text/javascript; charset=utf-8");
  EXPECT_NE(std::string(files.find("/assets/index-1a2b.js")->cache).find("immutable"), std::string::npos);
}

TEST_F(PageFolder, NothingOutsideItIsServed) {
  const PageFiles files(base_ / "page");
  for (const char* uri :
       {"/../secret.txt", "/assets/../../secret.txt", "//etc/passwd", "/etc/passwd", "/link.txt", "/.hidden",
        "/assets", "/assets/", "/..", "/.", "", "index.html", "/nothing.js", "/../page-of-another/file.txt",
        "/..\\secret.txt", "/assets\\index-1a2b.js"})
    EXPECT_FALSE(files.find(uri).has_value()) << uri;
  EXPECT_FALSE(files.find(std::string_view("/index.html\0.js", 15)).has_value());
  EXPECT_FALSE(files.find("/" + std::string(5000, 'a')).has_value());
}

TEST_F(PageFolder, AFolderWithoutAPageSaysHowToBuildIt) {
  for (const fs::path& folder : {base_ / "page-of-another", base_ / "nowhere"}) {
    try {
      const PageFiles files(folder);
      FAIL() << folder;
    } catch (const client::ClientError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(folder.string()), std::string::npos) << text;
      EXPECT_NE(text.find("npm run build"), std::string::npos) << text;
    }
  }
}

}  // namespace
}  // namespace palpate::viewer
