// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/read_volume_mesh.h"

#include "core/model/meta_model.h"

namespace palpate::modelfile {

namespace {

template <typename T>
std::vector<T> copy(std::span<const T> values) {
  return {values.begin(), values.end()};
}

}  // namespace

VolumeMesh readVolumeMesh(const std::filesystem::path& model) {
  const MetaModel loaded = MetaModel::load(model);
  const ModelView& v = loaded.view();
  return {copy(v.mesh_nodes),
          copy(v.mesh_tetrahedra),
          copy(v.mesh_midsides),
          copy(v.mesh_node_tag),
          copy(v.mesh_tetrahedron_tag),
          copy(v.mesh_fixed),
          copy(v.mesh_surface_node),
          copy(v.mesh_element_region),
          copy(v.region_name),
          copy(v.region_E),
          copy(v.region_nu),
          copy(v.region_law),
          copy(v.spring_node),
          copy(v.spring_stiffness)};
}

}  // namespace palpate::modelfile
