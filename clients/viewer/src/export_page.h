// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace palpate::viewer {

/// What was written.
struct Exported {
  std::size_t files{0};
  std::uintmax_t bytes{0};
};

/// Before anything is written. @throw client::ClientError  the page is not there or not whole, or `folder` is in use or inside it
void checkFolders(const std::filesystem::path& page, const std::filesystem::path& folder);

/// Writes the page as files that any web server can serve: the page, core as WebAssembly, and a model, which index.html
/// names. The page itself checks the model; here only its signature is.
/// @param[in] page    folder of the built page
/// @param[in] folder  absent or empty; as before after a failure
/// @param[in] model   HDF5 file; empty: none, and the page asks for one
/// @throw client::ClientError  which of them is not what it should be, or the file that could not be written
[[nodiscard]] Exported exportPage(const std::filesystem::path& page, const std::filesystem::path& folder,
                                  const std::filesystem::path& model);

}  // namespace palpate::viewer
