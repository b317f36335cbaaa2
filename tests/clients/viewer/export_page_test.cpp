// SPDX-License-Identifier: Apache-2.0
// The page as files for any web server.
#include "export_page.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "palpate/client/error.h"
#include "palpate/testing/files.h"

namespace palpate::viewer {
namespace fs = std::filesystem;
namespace {

const std::string kModel = "\x89HDF\r\n\x1a\n and more";

class ExportedPage : public ::testing::Test {
 protected:
  ExportedPage() {
    fs::create_directories(base_ / "page" / "core");
    fs::create_directories(base_ / "page" / "assets");
    base_.write("page/index.html", "<html><head><title>x</title></head><body></body></html>");
    base_.write("page/assets/index-1a2b.js", "script");
    base_.write("page/core/palpate_core.mjs", "core");
    base_.write("page/core/palpate_core.wasm", "wasm");
    base_.write("liver.h5", kModel);
  }

  Exported run(const std::string& folder, const fs::path& model) {
    return exportPage(base_ / "page", base_ / folder, model);
  }

  /// What is said of an export that fails, after which the folder is as it was.
  std::string complaint(const std::string& folder, const fs::path& model) {
    const bool was_there = fs::exists(base_ / folder);
    try {
      (void)run(folder, model);
    } catch (const client::ClientError& error) {
      EXPECT_EQ(fs::exists(base_ / folder), was_there);
      return error.what();
    }
    return "nothing is wrong";
  }

  bool says(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

  const testing::TemporaryFolder base_;
};

TEST_F(ExportedPage, HoldsPageCoreAndModelAndNamesIt) {
  const Exported written = run("out", base_ / "liver.h5");
  EXPECT_EQ(written.files, 5U);
  EXPECT_EQ(testing::contentOf(base_ / "out/liver.h5"), kModel);
  EXPECT_EQ(testing::contentOf(base_ / "out/assets/index-1a2b.js"), "script");
  EXPECT_EQ(testing::contentOf(base_ / "out/core/palpate_core.wasm"), "wasm");
  const std::string index = testing::contentOf(base_ / "out/index.html");
  EXPECT_TRUE(says(index, "<meta name=\"palpate-model\" content=\"./liver.h5\" />\n  </head>")) << index;
  EXPECT_EQ(written.bytes, kModel.size() + std::string("scriptcorewasm").size() + index.size());
}

TEST_F(ExportedPage, SaysThatItHasNoServerAlsoWithoutAModel) {
  fs::create_directories(base_ / "empty");
  EXPECT_EQ(run("empty", "").files, 4U);
  EXPECT_TRUE(says(testing::contentOf(base_ / "empty/index.html"), "name=\"palpate-model\" content=\"\""));
}

TEST_F(ExportedPage, EncodesWhatAnAddressOrHtmlWouldTakeForItsOwn) {
  (void)run("out", base_.write("a \"b\"?<ö>.h5", kModel));
  EXPECT_TRUE(
      says(testing::contentOf(base_ / "out/index.html"), "content=\"./a%20%22b%22%3F%3C%C3%B6%3E.h5\""));
}

TEST_F(ExportedPage, RefusesWhatIsNoModel) {
  EXPECT_TRUE(says(complaint("out", base_ / "none.h5"), "none.h5 is not a file"));
  EXPECT_TRUE(says(complaint("out", base_ / "page"), "is not a file"));
  EXPECT_TRUE(says(complaint("out", base_.write("short.h5", "\x89HDF")),
                   "short.h5 cannot be read, or is not a model"));
  EXPECT_TRUE(
      says(complaint("out", base_.write("wrong.h5", "PK and more than eight bytes")), "as HDF5 files do"));
  EXPECT_TRUE(
      says(complaint("out", base_.write("index.html", kModel)), "has the name of a file of the page"));
}

TEST_F(ExportedPage, RefusesAFolderThatIsInUse) {
  EXPECT_TRUE(says(complaint("page", base_ / "liver.h5"), "page is not an empty folder"));
  EXPECT_TRUE(says(complaint("liver.h5", base_ / "liver.h5"), "liver.h5 is not an empty folder"));
  EXPECT_TRUE(says(complaint("liver.h5/below", base_ / "liver.h5"), "cannot write"));
}

TEST_F(ExportedPage, RefusesAFolderInsideThePage) {
  EXPECT_TRUE(says(complaint("page/out", ""), "page/out is inside the page's folder"));
  EXPECT_TRUE(says(complaint("page/assets/../a/b", ""), "is inside the page's folder"));
  EXPECT_EQ(run("page-beside", "").files, 4U);
}

TEST_F(ExportedPage, RefusesAFolderWithoutAName) {
  try {
    (void)exportPage(base_ / "page", "", "");
    FAIL() << "it was taken";
  } catch (const client::ClientError& error) {
    EXPECT_STREQ(error.what(), "--export names no folder");
  }
}

TEST_F(ExportedPage, LeavesNoFolderAboveOneThatFailed) {
  base_.write("page/index.html", "no head");
  EXPECT_TRUE(says(complaint("a/b/c", ""), "has no </head>"));
  EXPECT_FALSE(fs::exists(base_ / "a"));
}

TEST_F(ExportedPage, RefusesAPageWithoutItsParts) {
  fs::remove(base_ / "page/core/palpate_core.wasm");
  EXPECT_TRUE(says(complaint("out", ""), "has no core/palpate_core.wasm"));
  base_.write("page/core/palpate_core.wasm", "wasm");
  base_.write("page/index.html", "no head");
  fs::create_directories(base_ / "empty");
  EXPECT_TRUE(says(complaint("empty", ""), "has no </head>"));
  EXPECT_TRUE(fs::is_empty(base_ / "empty"));
  EXPECT_TRUE(says(complaint("out", ""), "has no </head>"));
  fs::remove(base_ / "page/index.html");
  EXPECT_TRUE(says(complaint("out", ""), "no index.html"));
}

}  // namespace
}  // namespace palpate::viewer
