// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/preview.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "tools/make/organ/painted_groups.h"
#include "tools/program/printed.h"

namespace palpate::organ {
namespace {

// The surface as the boundary of a mesh whose inside is not there yet.
Preview ofSolid(const mesh::Solid& solid) {
  Preview preview;
  preview.mesh.nodes = solid.surface.vertices;
  for (std::size_t v = 0; v < solid.surface.vertices.size(); ++v) {
    preview.boundary.nodes.push_back(static_cast<std::int32_t>(v));
    preview.mesh.node_tags.push_back(static_cast<std::int64_t>(v + 1));
  }
  preview.boundary.triangles = preview.boundary.faces = solid.surface.triangles;
  return preview;
}

std::vector<char> marked(const mesh::TetMesh& mesh, const char* group) {
  std::vector<char> is_in(mesh.nodes.size(), 0);
  const auto found = mesh.groups.find(group);
  if (found != mesh.groups.end())
    for (const auto node : found->second) is_in[static_cast<std::size_t>(node)] = 1;
  return is_in;
}

void measure(Preview& preview) {
  const std::vector<char> held = marked(preview.mesh, "fixed"), touched = marked(preview.mesh, "accessible");
  for (const auto node : preview.boundary.nodes) {
    const auto i = static_cast<std::size_t>(node);
    ++(held[i] ? preview.held : touched[i] ? preview.touchable : preview.neither).nodes;
  }
  for (const auto& t : preview.boundary.triangles) {
    const auto node = [&](std::size_t k) {
      return static_cast<std::size_t>(preview.boundary.nodes[static_cast<std::size_t>(t[k])]);
    };
    const auto all = [&](const std::vector<char>& in) { return in[node(0)] && in[node(1)] && in[node(2)]; };
    const Eigen::Vector3d& a = preview.mesh.nodes[node(0)];
    SurfacePart& part = all(held) ? preview.held : all(touched) ? preview.touchable : preview.neither;
    ++part.triangles;
    part.area += (preview.mesh.nodes[node(1)] - a).cross(preview.mesh.nodes[node(2)] - a).norm() / 2;
  }
}

program::Json toJson(const SurfacePart& part) {
  return {{"nodes", part.nodes}, {"triangles", part.triangles}, {"area", part.area}};
}

}  // namespace

Preview previewOrgan(const std::filesystem::path& path, const ImportOptions& options) {
  Preview preview;
  std::vector<std::string> notes;
  if (const auto read = solidOf(path, options, notes)) {
    preview = ofSolid(read->solid);
    addPaintedGroups(read->painted, preview.boundary, preview.mesh);
    setBoundaryGroups(preview.mesh, preview.boundary, options.fixed);
    preview.notes = std::move(notes);
  } else {
    ImportedOrgan organ = importOrgan(path, options);
    preview.mesh = std::move(organ.mesh);
    preview.boundary = std::move(organ.boundary);
    preview.notes = std::move(organ.notes);
  }
  measure(preview);
  return preview;
}

program::Json toJson(const Preview& preview) {
  return {{"dry_run", true},
          {"held", toJson(preview.held)},
          {"touchable", toJson(preview.touchable)},
          {"neither", toJson(preview.neither)},
          {"warnings", preview.notes}};
}

void print(std::ostream& out, const Preview& preview) {
  const double whole = preview.held.area + preview.touchable.area + preview.neither.area;
  const auto tell = [&](const char* name, const SurfacePart& part) {
    out << program::printed("%-16s %.4g cm^2, %.1f %% of the surface: %zu triangles, %zu nodes\n", name,
                            1e4 * part.area, 100 * part.area / whole, part.triangles, part.nodes);
  };
  tell("held", preview.held);
  tell("can be touched", preview.touchable);
  tell("neither", preview.neither);
  for (const auto& note : preview.notes) out << "warning: " << note << '\n';
}

}  // namespace palpate::organ
