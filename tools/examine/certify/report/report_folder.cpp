// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/report/report_folder.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "tools/program/write_file.h"

namespace palpate::certify {

namespace {

constexpr const char *kPage = "report.html", *kContent = "report.json";

void requireAccess(const std::filesystem::path& folder, const std::filesystem::path& named) {
  if (access(folder.c_str(), R_OK | W_OK | X_OK) != 0) throw program::WriteError(named, std::strerror(errno));
}

}  // namespace

ReportFolder::ReportFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  const auto status = std::filesystem::status(folder_, error);
  if (!std::filesystem::exists(status)) {
    // "folder/" is the folder too.
    const auto absolute = std::filesystem::absolute(folder_ / "").parent_path();
    if (std::filesystem::is_symlink(std::filesystem::symlink_status(absolute, error)))
      throw program::WriteError(folder_, "it is a link to a folder that is missing");
    requireAccess(absolute.parent_path(), folder_);
    return;
  }
  if (!std::filesystem::is_directory(status)) throw program::WriteError(folder_, "it is not a folder");
  requireAccess(folder_, folder_);
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    const std::string name = entry.path().filename().string();
    if (name != kPage && name != kContent)
      throw program::WriteError(folder_, "it holds other files, such as " + name);
  }
}

void ReportFolder::write(const std::string& page, const std::string& content) const {
  std::error_code error;
  std::filesystem::create_directory(folder_, error);
  if (error) throw program::WriteError(folder_, error.message());
  program::writeFile(folder_ / kContent, content);
  program::writeFile(folder_ / kPage, page);
}

}  // namespace palpate::certify
