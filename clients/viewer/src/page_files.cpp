// SPDX-License-Identifier: Apache-2.0
#include "page_files.h"

#include <algorithm>
#include <array>
#include <utility>

#include "palpate/client/error.h"

namespace palpate::viewer {
namespace fs = std::filesystem;
namespace {

const char* typeOf(const fs::path& path) {
  static constexpr std::array<std::pair<std::string_view, const char*>, 13> kTypes{{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".wasm", "application/wasm"},
      {".txt", "text/plain; charset=utf-8"},
  }};
  const std::string extension = path.extension().string();
  for (const auto& [name, type] : kTypes)
    if (name == extension) return type;
  return "application/octet-stream";
}

// A part may not start with a dot (.., .git), hold a backslash or be empty.
bool partsAreNames(std::string_view uri) {
  while (!uri.empty()) {
    const std::size_t slash = std::min(uri.find('/'), uri.size());
    const std::string_view part = uri.substr(0, slash);
    if (part.empty() || part.front() == '.' || part.find('\\') != part.npos || part.find('\0') != part.npos)
      return false;
    uri.remove_prefix(std::min(slash + 1, uri.size()));
  }
  return true;
}

bool isInside(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

PageFiles::PageFiles(const fs::path& folder) {
  std::error_code failure;
  folder_ = fs::canonical(folder, failure);
  if (failure || !fs::is_regular_file(folder_ / "index.html", failure))
    throw client::ClientError("the page is not in " + folder.string() +
                              " (no index.html): build it with tools/demo, or in clients/viewer/web with "
                              "`npm ci && npm run build`; or name its folder with --page");
}

std::optional<PageFile> PageFiles::find(std::string_view uri) const {
  if (!uri.starts_with('/') || uri.size() > 1024) return std::nullopt;
  uri.remove_prefix(1);
  if (uri.empty()) uri = "index.html";
  if (!partsAreNames(uri)) return std::nullopt;
  std::error_code failure;
  const fs::path path = fs::canonical(folder_ / uri, failure);  // follows links; their target is judged
  if (failure || !isInside(path, folder_) || !fs::is_regular_file(path, failure)) return std::nullopt;
  const bool hashed = uri.starts_with("assets/");  // Vite names them by their content
  return PageFile{path, typeOf(path), hashed ? "public, max-age=31536000, immutable" : "no-cache"};
}

fs::path defaultPageFolder() {
  std::error_code failure;
  const fs::path bin = fs::read_symlink("/proc/self/exe", failure).parent_path();
  const fs::path installed = (bin / PALPATE_PAGE_FROM_BIN).lexically_normal();
  if (fs::is_regular_file(installed / "index.html", failure)) return installed;
  return (bin / PALPATE_PAGE_FROM_BUILD).lexically_normal();
}

}  // namespace palpate::viewer
