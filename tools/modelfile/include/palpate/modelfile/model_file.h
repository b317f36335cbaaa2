// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>

#include "palpate/modelfile/model_data.h"

namespace palpate::modelfile {

/// Data that do not fit together, or a file that cannot be written or read. what() is one sentence.
class ModelFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes a model file (docs/model_file.md): version 1 for "displacement", version 2 for "force" and "level".
/// Contiguous, early-allocated, aligned to 4096 bytes.
/// Written to `path.tmp-PID` beside the target, synced, renamed: a reader sees the old file or the new one,
/// never a part.
/// @throw ModelFileError naming the dataset when sizes do not fit each other, or the file that cannot be
/// written
void writeModel(const std::filesystem::path& path, const ModelData& data);

/// Writes `model.xdmf` beside the model (extension replaced): rest surface with each mode X_k as a vector
/// attribute, read by ParaView out of the model file itself. The model is checked by MetaModel::load first.
/// @return path of the .xdmf. @throw LoadError, ModelFileError
std::filesystem::path writeXdmf(const std::filesystem::path& model);

/// The volume mesh that a model was computed on.
struct VolumeMesh {
  std::vector<double> nodes;                  ///< [N][3] m
  std::vector<std::int32_t> tetrahedra;       ///< [V][4] 0-based
  std::vector<std::int64_t> node_tag;         ///< [N] number in the mesh file
  std::vector<std::int64_t> tetrahedron_tag;  ///< [V]
  std::vector<std::int32_t> fixed;            ///< volume nodes
  std::vector<std::int32_t> surface_node;     ///< [Ns] volume node of a surface node
};

/// @throw LoadError as MetaModel::load, which checks the file
[[nodiscard]] VolumeMesh readVolumeMesh(const std::filesystem::path& model);

}  // namespace palpate::modelfile
