// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace palpate::modelfile {

/// The volume mesh that a model was computed on.
struct VolumeMesh {
  std::vector<double> nodes;                  ///< [N][3] m
  std::vector<std::int32_t> tetrahedra;       ///< [V][4] 0-based
  std::vector<std::int32_t> midsides;         ///< [V][6] of quadratic elements, else empty
  std::vector<std::int64_t> node_tag;         ///< [N] number in the mesh file
  std::vector<std::int64_t> tetrahedron_tag;  ///< [V]
  std::vector<std::int32_t> fixed;            ///< volume nodes
  std::vector<std::int32_t> surface_node;     ///< [Ns] volume node of a surface node
};

/// @throw LoadError as MetaModel::load, which checks the file
[[nodiscard]] VolumeMesh readVolumeMesh(const std::filesystem::path& model);

}  // namespace palpate::modelfile
