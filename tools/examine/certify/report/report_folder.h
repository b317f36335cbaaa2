// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace palpate::certify {

/// Where a report goes: a folder with report.html and report.json, and nothing else.
class ReportFolder {
 public:
  /// Checks it before the hours that an examination may take; makes nothing yet.
  /// @throw program::WriteError  it is a file or a dangling link, cannot be written or made, or holds other files
  explicit ReportFolder(std::filesystem::path folder);
  /// Makes the folder where it is missing. @throw program::WriteError
  void write(const std::string& page, const std::string& content) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace palpate::certify
