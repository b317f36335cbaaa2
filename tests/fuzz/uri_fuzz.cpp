// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "page_files.h"
#include "targets.h"

namespace palpate::fuzz {

namespace {

namespace fs = std::filesystem;

/// A page's folder, with what must not be served: a hidden file, a link that leads out, a file beside it.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "palpate_fuzz_XXXXXX").string();
    require(mkdtemp(name.data()) != nullptr, "there is a folder for temporary files");
    path_ = fs::canonical(name);
    fs::create_directories(path_ / "page" / "assets");
    for (const char* file : {"secret", "page/index.html", "page/.git", "page/assets/a.js"})
      std::ofstream(path_ / file) << "x";
    fs::create_symlink(path_ / "secret", path_ / "page" / "out");
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] fs::path page() const { return path_ / "page"; }

 private:
  fs::path path_;
};

}  // namespace

bool uri(Bytes input) {
  static const Folder folder;
  static const viewer::PageFiles files(folder.page());
  const auto found = files.find({reinterpret_cast<const char*>(input.data()), input.size()});
  if (!found) return false;
  require(found->path == folder.page() / "index.html" || found->path == folder.page() / "assets" / "a.js",
          "what is served belongs to the page");
  return true;
}

}  // namespace palpate::fuzz
