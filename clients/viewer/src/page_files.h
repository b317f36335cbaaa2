// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace palpate::viewer {

/// A file of the page, ready to send.
struct PageFile {
  std::filesystem::path path;
  const char* type;   ///< MIME
  const char* cache;  ///< Cache-Control
};

/// The folder of the page's files; nothing outside it is served.
class PageFiles {
 public:
  /// @throw client::ClientError  the folder holds no index.html; says how to build it
  explicit PageFiles(const std::filesystem::path& folder);

  /// @param[in] uri  decoded path of a request, from "/" on
  /// @return nothing when the folder holds no such regular file, or a part of the path starts with a dot
  /// Real-time: no. Threads: any.
  [[nodiscard]] std::optional<PageFile> find(std::string_view uri) const;

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

 private:
  std::filesystem::path folder_;  // canonical
};

/// The page's folder by default: beside the installed program, else in the source tree.
[[nodiscard]] std::filesystem::path defaultPageFolder();

}  // namespace palpate::viewer
