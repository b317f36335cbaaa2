// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/data/datasets.h"

namespace palpate::modelfile {

/// The volume mesh that a model was computed on, and what it is made of beside the attributes.
struct VolumeMesh {
  std::vector<double> nodes;                  ///< [N][3] m
  std::vector<std::int32_t> tetrahedra;       ///< [V][4] 0-based
  std::vector<std::int32_t> midsides;         ///< [V][6] of quadratic elements, else empty
  std::vector<std::int64_t> node_tag;         ///< [N] number in the mesh file
  std::vector<std::int64_t> tetrahedron_tag;  ///< [V]
  std::vector<std::int32_t> fixed;            ///< volume nodes
  std::vector<std::int32_t> surface_node;     ///< [Ns] volume node of a surface node
  // Regions and springs, as in the file; empty where it has none.
  std::vector<std::int32_t> element_region;  ///< [V]
  std::vector<RegionName> region_name;       ///< [R]
  std::vector<double> region_E;              ///< [R] Pa
  std::vector<double> region_nu;             ///< [R]
  std::vector<RegionName> region_law;        ///< [R]
  std::vector<std::int32_t> spring_node;     ///< [S]
  std::vector<double> spring_stiffness;      ///< [S] N/m
};

/// @throw LoadError as MetaModel::load, which checks the file
[[nodiscard]] VolumeMesh readVolumeMesh(const std::filesystem::path& model);

}  // namespace palpate::modelfile
