// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/scratch_model.h"

#include <unistd.h>

#include <filesystem>
#include <string>

#include "tools/modelfile/write_model.h"

namespace palpate::bench {

namespace {

/// A unique file name; the destructor removes the file.
class ScratchFile {
 public:
  ScratchFile()
      : path_(std::filesystem::temp_directory_path() /
              ("palpate-bench-" + std::to_string(::getpid()) + ".h5")) {}
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() {
    std::error_code gone;
    std::filesystem::remove(path_, gone);
  }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

MetaModel throughFile(const modelfile::ModelData& data) {
  const ScratchFile file;
  modelfile::writeModel(file.path(), data);
  return MetaModel::load(file.path());
}

}  // namespace palpate::bench
