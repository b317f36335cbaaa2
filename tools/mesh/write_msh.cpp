// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/write_msh.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "tools/mesh/mesh_error.h"
#include "tools/program/write_file.h"

namespace palpate::mesh {
namespace {

using Groups = std::vector<int>;  // numbers of physical groups, ascending
constexpr int kOrgan = 1;         // the physical volume of all tetrahedra

// One entity of the Gmsh model for each combination of groups, so an element in two groups is written once.
template <std::size_t Corners>
using Entities = std::map<Groups, std::vector<std::array<std::int32_t, Corners>>>;

struct Layout {
  std::vector<std::string> names;  // of physical group i + 1
  Groups volume{kOrgan};
  Entities<3> surfaces;
  Entities<1> points;
};

void checkName(const std::string& name) {
  if (name.empty() || name.find_first_of("\"\n\r") != std::string::npos) {
    throw MeshError("the group name '" + name + "' cannot be written to a .msh file");
  }
}

// Groups that each node belongs to.
std::vector<Groups> membership(const TetMesh& mesh, Layout& layout) {
  std::vector<Groups> member(mesh.nodes.size());
  layout.names = {"organ"};
  for (const auto& [name, nodes] : mesh.groups) {
    checkName(name);
    const bool whole = nodes.size() == mesh.nodes.size();
    if (whole && name == "organ") continue;
    if (name == "organ") throw MeshError("the group name 'organ' is kept for the whole volume");
    layout.names.push_back(name);
    const int number = static_cast<int>(layout.names.size());
    if (whole) layout.volume.push_back(number);
    if (whole) continue;
    for (const auto node : nodes) member[static_cast<std::size_t>(node)].push_back(number);
  }
  return member;
}

Groups common(const Groups& a, const Groups& b) {
  Groups both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

Layout layoutOf(const TetMesh& mesh, const BoundarySurface& boundary) {
  Layout layout;
  const std::vector<Groups> member = membership(mesh, layout);
  std::vector<Groups> left = member;  // not yet covered by a triangle
  for (const auto& triangle : boundary.triangles) {
    std::array<std::int32_t, 3> nodes{};
    for (std::size_t i = 0; i < 3; ++i) nodes[i] = boundary.nodes[static_cast<std::size_t>(triangle[i])];
    const auto of = [&](std::size_t i) -> const Groups& {
      return member[static_cast<std::size_t>(nodes[i])];
    };
    const Groups shared = common(common(of(0), of(1)), of(2));
    layout.surfaces[shared].push_back(nodes);
    for (const auto node : nodes) {
      std::erase_if(left[static_cast<std::size_t>(node)],
                    [&](int group) { return std::binary_search(shared.begin(), shared.end(), group); });
    }
  }
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!left[i].empty()) layout.points[left[i]].push_back({static_cast<std::int32_t>(i)});
  }
  return layout;
}

void writeNames(std::ostream& out, const Layout& layout) {
  std::map<std::pair<int, int>, std::string> names;  // dimension, number
  const auto add = [&](int dimension, const Groups& groups) {
    for (const int g : groups) names[{dimension, g}] = layout.names[static_cast<std::size_t>(g - 1)];
  };
  add(3, layout.volume);
  for (const auto& [groups, triangles] : layout.surfaces) add(2, groups);
  for (const auto& [groups, nodes] : layout.points) add(0, groups);
  out << "$PhysicalNames\n" << names.size() << '\n';
  for (const auto& [id, name] : names) out << id.first << ' ' << id.second << " \"" << name << "\"\n";
  out << "$EndPhysicalNames\n";
}

void writeGroups(std::ostream& out, const Groups& groups) {
  out << ' ' << groups.size();
  for (const int g : groups) out << ' ' << g;
}

void writeEntities(std::ostream& out, const TetMesh& mesh, const Layout& layout) {
  Eigen::Vector3d low = mesh.nodes.front();
  Eigen::Vector3d high = low;
  for (const auto& x : mesh.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const auto point = [&](const Eigen::Vector3d& x) { out << ' ' << x.x() << ' ' << x.y() << ' ' << x.z(); };
  out << "$Entities\n" << layout.points.size() << " 0 " << layout.surfaces.size() << " 1\n";
  int tag = 0;
  for (const auto& [groups, nodes] : layout.points) {
    out << ++tag;
    point(mesh.nodes[static_cast<std::size_t>(nodes.front()[0])]);
    writeGroups(out, groups);
    out << '\n';
  }
  tag = 0;
  for (const auto& [groups, triangles] : layout.surfaces) {
    out << ++tag;
    point(low);
    point(high);
    writeGroups(out, groups);
    out << " 0\n";
  }
  out << 1;
  point(low);
  point(high);
  writeGroups(out, layout.volume);
  out << ' ' << layout.surfaces.size();
  for (int s = 1; s <= tag; ++s) out << ' ' << s;
  out << "\n$EndEntities\n";
}

void writeNodes(std::ostream& out, const TetMesh& mesh) {
  const std::size_t count = mesh.nodes.size();
  out << "$Nodes\n1 " << count << " 1 " << count << "\n3 1 0 " << count << '\n';
  for (std::size_t i = 1; i <= count; ++i) out << i << '\n';
  for (const auto& x : mesh.nodes) out << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
  out << "$EndNodes\n";
}

template <std::size_t Corners>
void writeBlock(std::ostream& out, int dimension, int entity, int type, std::size_t& tag,
                const std::vector<std::array<std::int32_t, Corners>>& elements) {
  out << dimension << ' ' << entity << ' ' << type << ' ' << elements.size() << '\n';
  for (const auto& element : elements) {
    out << ++tag;
    for (const auto node : element) out << ' ' << node + 1;
    out << '\n';
  }
}

void writeElements(std::ostream& out, const TetMesh& mesh, const Layout& layout) {
  constexpr int kPoint = 15;
  constexpr int kTriangle = 2;
  constexpr int kTetrahedron = 4;
  std::size_t count = mesh.tetrahedra.size();
  for (const auto& [groups, triangles] : layout.surfaces) count += triangles.size();
  for (const auto& [groups, nodes] : layout.points) count += nodes.size();
  out << "$Elements\n"
      << 1 + layout.surfaces.size() + layout.points.size() << ' ' << count << " 1 " << count << '\n';
  std::size_t tag = 0;
  writeBlock(out, 3, 1, kTetrahedron, tag, mesh.tetrahedra);
  int entity = 0;
  for (const auto& [groups, triangles] : layout.surfaces)
    writeBlock(out, 2, ++entity, kTriangle, tag, triangles);
  entity = 0;
  for (const auto& [groups, nodes] : layout.points) writeBlock(out, 0, ++entity, kPoint, tag, nodes);
  out << "$EndElements\n";
}

void writeSections(std::ostream& out, const TetMesh& mesh, const Layout& layout) {
  out.precision(17);
  out << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  writeNames(out, layout);
  writeEntities(out, mesh, layout);
  writeNodes(out, mesh);
  writeElements(out, mesh, layout);
}

}  // namespace

void writeMsh(const std::filesystem::path& path, const TetMesh& mesh, const BoundarySurface& boundary) {
  const Layout layout = layoutOf(mesh, boundary);
  try {
    program::writeFile(path, [&](std::ostream& out) { writeSections(out, mesh, layout); });
  } catch (const program::WriteError& error) {
    throw MeshError(path.string() + ": cannot be written: " + error.reason());
  }
}

}  // namespace palpate::mesh
