// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/data/hdf5_handle.h"

// What the writers of a model file and of its certificate share. All throw ModelFileError naming what cannot be written.
namespace palpate::modelfile {

void require(bool good, const std::string& what);

/// How a model file is opened for writing: its objects begin at multiples of 64 bytes.
[[nodiscard]] Hdf5Handle aligned();

/// A text attribute of the root, of variable length: a long one does not meet the 64 KiB limit of an object header.
void writeText(const Hdf5Handle& file, const char* name, const std::string& text);
/// A text that is not in the content's digest, and its own digest beside it.
void writeWithDigest(const Hdf5Handle& file, const std::string& name, const std::string& text);
/// The three attributes of a certificate. @param content  digest of what it belongs to, hexadecimal
void writeCertificateTexts(const Hdf5Handle& file, const std::string& certificate,
                           const std::string& content);

/// The data have to be on the disk before a name points to them: else a crash could leave a name without a model.
void sync(const std::filesystem::path& path);
/// The same of the folder that holds the path.
void syncFolder(const std::filesystem::path& path);

}  // namespace palpate::modelfile
