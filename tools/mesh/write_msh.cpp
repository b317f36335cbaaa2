// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/write_msh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "tools/mesh/mesh_error.h"
#include "tools/program/write_file.h"

namespace palpate::mesh {
namespace {

using Groups = std::vector<int>;  // numbers of physical groups, ascending
constexpr int kOrgan = 1;         // the physical volume of all tetrahedra

struct Element {
  std::size_t tag;
  std::vector<std::int32_t> nodes;
};

// One entity of the Gmsh model for each combination of groups, so an element in two groups is written once.
using Entities = std::map<Groups, std::vector<Element>>;

struct Layout {
  std::vector<std::string> names;  // of physical group i + 1
  std::vector<Groups> of_tetrahedron, of_node;
  Entities volumes, surfaces, points;
};

int addName(const std::string& name, Layout& layout) {
  if (name.empty() || name.find_first_of("\"\n\r") != std::string::npos) {
    throw MeshError("the group name '" + name + "' cannot be written to a .msh file");
  }
  if (name == "organ") throw MeshError("the group name 'organ' is kept for the whole volume");
  const auto at = std::find(layout.names.begin(), layout.names.end(), name);
  if (at != layout.names.end()) return static_cast<int>(at - layout.names.begin()) + 1;
  layout.names.push_back(name);
  return static_cast<int>(layout.names.size());
}

// Regions, and groups of all nodes.
void addVolumeGroups(const TetMesh& mesh, Layout& layout) {
  layout.of_tetrahedron.assign(mesh.tetrahedra.size(), {kOrgan});
  for (const auto& [name, tetrahedra] : mesh.regions) {
    if (name == "organ" && tetrahedra.size() == mesh.tetrahedra.size()) continue;
    const int number = addName(name, layout);
    for (const auto t : tetrahedra) layout.of_tetrahedron[static_cast<std::size_t>(t)].push_back(number);
  }
  for (const auto& [name, nodes] : mesh.groups) {
    if (nodes.size() != mesh.nodes.size() || name == "organ" || mesh.regions.contains(name)) continue;
    const int number = addName(name, layout);
    for (Groups& groups : layout.of_tetrahedron) groups.push_back(number);
  }
}

// What a region's name gives each node when the file is read: no surface or point needs to say it.
std::vector<Groups> givenByRegions(const TetMesh& mesh, const Layout& layout) {
  std::vector<Groups> given(mesh.nodes.size());
  const auto give = [&](std::int32_t node, const Groups& groups) {
    Groups& own = given[static_cast<std::size_t>(node)];
    for (const int group : groups)
      if (std::find(own.begin(), own.end(), group) == own.end()) own.push_back(group);
  };
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (const auto node : mesh.tetrahedra[t]) give(node, layout.of_tetrahedron[t]);
    if (!mesh.isQuadratic()) continue;
    for (const auto node : mesh.midsides[t]) give(node, layout.of_tetrahedron[t]);
  }
  return given;
}

void addNodeGroups(const TetMesh& mesh, Layout& layout) {
  const std::vector<Groups> given = givenByRegions(mesh, layout);
  layout.of_node.resize(mesh.nodes.size());
  for (const auto& [name, nodes] : mesh.groups) {
    if (name == "organ" && nodes.size() == mesh.nodes.size()) continue;
    const int number = addName(name, layout);
    for (const auto node : nodes) {
      const Groups& has = given[static_cast<std::size_t>(node)];
      if (std::find(has.begin(), has.end(), number) != has.end()) continue;
      layout.of_node[static_cast<std::size_t>(node)].push_back(number);
    }
  }
  for (Groups& groups : layout.of_node) std::sort(groups.begin(), groups.end());
}

void addTetrahedra(const TetMesh& mesh, Layout& layout) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    Element element{t + 1, {mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end()}};
    if (mesh.isQuadratic()) {
      const auto& m = mesh.midsides[t];
      element.nodes.insert(element.nodes.end(), {m[0], m[1], m[2], m[3], m[5], m[4]});  // Gmsh's order
    }
    layout.volumes[layout.of_tetrahedron[t]].push_back(std::move(element));
  }
}

// The nodes of a face of the boundary: three corners, then three middles of quadratic elements.
std::vector<std::int32_t> nodesOf(const BoundarySurface& boundary, std::size_t face, bool is_quadratic) {
  std::vector<std::int32_t> nodes(boundary.faces[face].begin(), boundary.faces[face].end());
  if (is_quadratic) {
    const auto& middles = boundary.triangles[4 * face + 3];  // the last of splitFace()
    nodes.insert(nodes.end(), middles.begin(), middles.end());
  }
  for (auto& node : nodes) node = boundary.nodes[static_cast<std::size_t>(node)];
  return nodes;
}

Groups common(const Groups& a, const Groups& b) {
  Groups both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

// The boundary, in it whole faces of node groups; nodes that no such face holds become points.
void addBoundary(const TetMesh& mesh, const BoundarySurface& boundary, Layout& layout) {
  std::size_t tag = mesh.tetrahedra.size();
  std::vector<Groups> left = layout.of_node;  // not yet covered by a face
  for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
    std::vector<std::int32_t> nodes = nodesOf(boundary, f, mesh.isQuadratic());
    Groups shared = layout.of_node[static_cast<std::size_t>(nodes.front())];
    for (const auto node : nodes) shared = common(shared, layout.of_node[static_cast<std::size_t>(node)]);
    for (const auto node : nodes) {
      std::erase_if(left[static_cast<std::size_t>(node)],
                    [&](int group) { return std::binary_search(shared.begin(), shared.end(), group); });
    }
    layout.surfaces[shared].push_back({0, std::move(nodes)});
  }
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!left[i].empty()) layout.points[left[i]].push_back({0, {static_cast<std::int32_t>(i)}});
  }
  for (Entities* entities : {&layout.surfaces, &layout.points})
    for (auto& [groups, elements] : *entities)
      for (Element& element : elements) element.tag = ++tag;
}

Layout layoutOf(const TetMesh& mesh, const BoundarySurface& boundary) {
  Layout layout;
  layout.names = {"organ"};
  addVolumeGroups(mesh, layout);
  addNodeGroups(mesh, layout);
  addTetrahedra(mesh, layout);
  addBoundary(mesh, boundary, layout);
  return layout;
}

void writeNames(std::ostream& out, const Layout& layout) {
  std::map<std::pair<int, int>, std::string> names;  // dimension, number
  const auto add = [&](int dimension, const Entities& entities) {
    for (const auto& [groups, elements] : entities)
      for (const int g : groups) names[{dimension, g}] = layout.names[static_cast<std::size_t>(g - 1)];
  };
  add(3, layout.volumes);
  add(2, layout.surfaces);
  add(0, layout.points);
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
  out << "$Entities\n"
      << layout.points.size() << " 0 " << layout.surfaces.size() << ' ' << layout.volumes.size() << '\n';
  int tag = 0;
  for (const auto& [groups, elements] : layout.points) {
    out << ++tag;
    point(mesh.nodes[static_cast<std::size_t>(elements.front().nodes.front())]);
    writeGroups(out, groups);
    out << '\n';
  }
  for (const Entities* entities : {&layout.surfaces, &layout.volumes}) {
    tag = 0;
    for (const auto& [groups, elements] : *entities) {
      out << ++tag;
      point(low);
      point(high);
      writeGroups(out, groups);
      out << " 0\n";  // of what bounds it
    }
  }
  out << "$EndEntities\n";
}

void writeNodes(std::ostream& out, const TetMesh& mesh) {
  const std::size_t count = mesh.nodes.size();
  out << "$Nodes\n1 " << count << " 1 " << count << "\n3 1 0 " << count << '\n';
  for (std::size_t i = 1; i <= count; ++i) out << i << '\n';
  for (const auto& x : mesh.nodes) out << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
  out << "$EndNodes\n";
}

// Gmsh's number for elements of so many nodes: point, triangle, quadratic triangle, and the same of tetrahedra.
int typeOf(const Element& element) {
  static const std::map<std::size_t, int> kTypes{{1, 15}, {3, 2}, {6, 9}, {4, 4}, {10, 11}};
  return kTypes.at(element.nodes.size());
}

void writeElements(std::ostream& out, const Layout& layout) {
  const std::array<std::pair<int, const Entities*>, 3> dimensions{
      {{3, &layout.volumes}, {2, &layout.surfaces}, {0, &layout.points}}};
  std::size_t blocks = 0;
  std::size_t count = 0;
  for (const auto& [dimension, entities] : dimensions) {
    blocks += entities->size();
    for (const auto& [groups, elements] : *entities) count += elements.size();
  }
  out << "$Elements\n" << blocks << ' ' << count << " 1 " << count << '\n';
  for (const auto& [dimension, entities] : dimensions) {
    int entity = 0;
    for (const auto& [groups, elements] : *entities) {
      out << dimension << ' ' << ++entity << ' ' << typeOf(elements.front()) << ' ' << elements.size()
          << '\n';
      for (const auto& element : elements) {
        out << element.tag;
        for (const auto node : element.nodes) out << ' ' << node + 1;
        out << '\n';
      }
    }
  }
  out << "$EndElements\n";
}

void writeSections(std::ostream& out, const TetMesh& mesh, const Layout& layout) {
  out.precision(17);
  out << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  writeNames(out, layout);
  writeEntities(out, mesh, layout);
  writeNodes(out, mesh);
  writeElements(out, layout);
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
