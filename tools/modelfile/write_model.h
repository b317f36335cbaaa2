// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/modelfile/model_data.h"

namespace palpate::modelfile {

/// Writes a model file (docs/model_file.md).
/// Contiguous, early-allocated, aligned to 64 bytes.
/// Written to `path.tmp-PID` beside the target, synced, renamed: a reader sees the old file or the new one,
/// never a part.
/// @throw ModelFileError naming the dataset when sizes do not fit each other, or the file that cannot be
/// written
void writeModel(const std::filesystem::path& path, const ModelData& data);

/// The same of numbers as a file has them, fields in whole numbers.
/// @param attributes  force_order as in a file, not 0  @param view  of sizes that fit each other, such as a loaded model's
/// @param compact  each array in the fewest bytes that hold its numbers  @throw ModelFileError
void writeModel(const std::filesystem::path& path, const ModelAttributes& attributes, const ModelView& view,
                bool compact);

/// The same right into a file, which is not synced; what is there goes. @throw ModelFileError
void writeModelTo(const std::filesystem::path& path, const ModelAttributes& attributes, const ModelView& view,
                  bool compact);

/// Whether a file of these numbers is a compact one: fields of 8 bits. There is no mark of it in the view.
[[nodiscard]] bool isCompact(const ModelView& view);

/// About what writeModel() makes of it, bytes: arrays, and what HDF5 adds to them. @param data  parts may be empty
[[nodiscard]] std::uint64_t storedBytes(const ModelData& data);

}  // namespace palpate::modelfile
