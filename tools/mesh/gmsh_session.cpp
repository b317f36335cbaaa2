// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/gmsh_session.h"

#include <gmsh.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tools/mesh/mesh_error.h"

#if defined(__SANITIZE_ADDRESS__)
// Gmsh and OpenCASCADE leak memory when they finish; LeakSanitizer shall report our code only.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libgmsh\nleak:libTK\n";
}
#endif

namespace palpate::mesh {
namespace {

constexpr int kTetrahedron = 4;

[[noreturn]] void fail(const std::string& what, std::string reason) {
  for (auto& c : reason) c = c == '\n' ? ' ' : c;
  throw MeshError(what + ": " + (reason.empty() ? "Gmsh gives no reason" : reason));
}

std::string lastError() {
  std::string error;
  gmsh::logger::getLastError(error);
  return error;
}

/// @param element_tags  Gmsh's numbers of the mesh's tetrahedra
void addRegions(const std::vector<std::size_t>& element_tags, TetMesh& mesh) {
  std::map<std::size_t, std::int32_t> index;
  for (std::size_t t = 0; t < element_tags.size(); ++t) index[element_tags[t]] = static_cast<std::int32_t>(t);
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups, 3);
  for (const auto& [dimension, number] : groups) {
    std::string name;
    gmsh::model::getPhysicalName(dimension, number, name);
    if (name.empty()) continue;
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, number, entities);
    std::vector<std::int32_t>& region = mesh.regions[name];
    for (const int entity : entities) {
      std::vector<std::size_t> tags, corners;
      gmsh::model::mesh::getElementsByType(kTetrahedron, tags, corners, entity);
      for (const auto tag : tags) region.push_back(index.at(tag));
    }
    std::sort(region.begin(), region.end());
  }
}

}  // namespace

GmshSession::GmshSession() {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);  // the same mesh on every machine
}

GmshSession::~GmshSession() {
  gmsh::finalize();
}

void GmshSession::run(const std::string& what, const std::function<void()>& work) const {
  // Gmsh throws strings, numbers and OpenCASCADE's exceptions, depending on version and place.
  try {
    work();
  } catch (const std::exception& error) {
    fail(what, error.what());
  } catch (const std::string& error) {
    fail(what, error);
  } catch (const char* error) {
    fail(what, error);
  } catch (int) {
    fail(what, lastError());
  }
}

TetMesh GmshSession::tetrahedra() const {
  std::vector<std::size_t> node_tags, element_tags, corners;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(node_tags, coordinates, parameters);
  gmsh::model::mesh::getElementsByType(kTetrahedron, element_tags, corners);
  std::map<std::size_t, std::size_t> position;  // by Gmsh number: of the nodes that tetrahedra use
  for (std::size_t i = 0; i < node_tags.size(); ++i) position[node_tags[i]] = i;
  std::map<std::size_t, std::int32_t> index;
  for (const auto corner : corners) index[corner] = 0;
  TetMesh mesh;
  for (auto& [tag, i] : index) {
    const double* x = coordinates.data() + 3 * position.at(tag);
    i = static_cast<std::int32_t>(mesh.nodes.size());
    mesh.nodes.emplace_back(x[0], x[1], x[2]);
  }
  for (std::size_t c = 0; c + 3 < corners.size(); c += 4) {
    mesh.tetrahedra.push_back(
        {index[corners[c]], index[corners[c + 1]], index[corners[c + 2]], index[corners[c + 3]]});
  }
  mesh.node_tags.resize(mesh.nodes.size());
  mesh.tetrahedron_tags.resize(mesh.tetrahedra.size());
  std::iota(mesh.node_tags.begin(), mesh.node_tags.end(), 1);
  std::iota(mesh.tetrahedron_tags.begin(), mesh.tetrahedron_tags.end(), 1);
  addRegions(element_tags, mesh);
  return mesh;
}

}  // namespace palpate::mesh
