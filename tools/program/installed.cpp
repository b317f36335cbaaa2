// SPDX-License-Identifier: Apache-2.0
#include "tools/program/installed.h"

#include <filesystem>

namespace palpate::program {

std::string installedText(const std::string& from_bin) {
  std::error_code failure;  // then the path is not there
  const std::filesystem::path bin = std::filesystem::read_symlink("/proc/self/exe", failure).parent_path();
  const std::filesystem::path path = (bin / from_bin).lexically_normal();
  if (std::filesystem::path(from_bin).is_absolute() || std::filesystem::exists(path, failure))
    return path.string();
  return from_bin.starts_with("../") ? "PREFIX" + from_bin.substr(2) + " where palpate is installed"
                                     : from_bin;
}

}  // namespace palpate::program
