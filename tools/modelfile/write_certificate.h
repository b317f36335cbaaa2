// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/data/sha256.h"

namespace palpate::modelfile {

/// Puts a certificate into a model file; the one before goes. The model is loaded and written again, as it was stored: numbers
/// and digest are the same, and what else lay in the file goes.
/// Written to `path.tmp-PID` beside the file, synced, renamed: a reader sees the old file or the new one, and who has the old
/// one open keeps it. Of a symbolic link, the file that it leads to. docs/design.md, Certificate
/// @param certificate  text of a JSON object  @param content  MetaModel::digest() of what was examined
/// @throw ModelFileError naming the file that cannot be written, or whose content is another one by now
void writeCertificate(const std::filesystem::path& path, const std::string& certificate,
                      const Digest& content);

}  // namespace palpate::modelfile
