// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace palpate::viewer {

/// A file of the page, ready to be sent.
struct PageFile {
  std::filesystem::path path;
  const char* type;   ///< MIME
  const char* cache;  ///< Cache-Control
};

/// The folder that the page is served from, and nothing beside it.
class PageFiles {
 public:
  /// @throw client::ClientError when the folder holds no index.html, saying how to build it
  explicit PageFiles(const std::filesystem::path& folder);

  /// @param[in] uri  path of a request, decoded, from "/" on
  /// @return nothing when there is no such regular file inside the folder, or its name starts with a dot
  /// Real-time: no. Threads: any.
  [[nodiscard]] std::optional<PageFile> find(std::string_view uri) const;

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

 private:
  std::filesystem::path folder_;  // canonical
};

/// Where the page is unless the user says otherwise: beside the installed program, else in the source tree.
[[nodiscard]] std::filesystem::path defaultPageFolder();

}  // namespace palpate::viewer
