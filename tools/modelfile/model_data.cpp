// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/model_data.h"

namespace palpate::modelfile {

ModelView viewOf(const ModelData& d) {
  ModelView v;
  v.surface_positions = d.surface_positions;
  v.surface_triangles = d.surface_triangles;
  v.surface_mesh_tag = d.surface_mesh_tag;
  v.position_of_node = d.position_of_node;
  v.contact_node = d.contact_node;
  v.contact_accessible = d.contact_accessible;
  v.contact_force = d.contact_force;
  v.contact_displacement = d.contact_displacement;
  v.contact_domain_radius = d.contact_domain_radius;
  v.levels_Z = d.levels_Z;
  if (d.attributes.parameters == Parameters::kLevel && !d.contact_node.empty())
    v.level_functions = d.contact_displacement.size() / (3 * d.contact_node.size());
  v.modes_X = d.modes_X;
  v.modes_packed = d.modes_packed.view();
  v.modes_Y = d.modes_Y;
  v.near_offset = d.near_offset;
  v.near_node = d.near_node;
  v.near_field = d.near_field;
  v.mesh_nodes = d.mesh_nodes;
  v.mesh_tetrahedra = d.mesh_tetrahedra;
  v.mesh_node_tag = d.mesh_node_tag;
  v.mesh_tetrahedron_tag = d.mesh_tetrahedron_tag;
  v.mesh_fixed = d.mesh_fixed;
  v.mesh_surface_node = d.mesh_surface_node;
  return v;
}

}  // namespace palpate::modelfile
