// SPDX-License-Identifier: Apache-2.0
#include "core/data/model_reader.h"

#include <algorithm>
#include <array>

#include "core/base/multi_index.h"
#include "core/data/datasets.h"
#include "core/data/model_checks.h"
#include "core/data/model_content.h"

namespace palpate {

namespace {

Parameters readParameters(const ModelSource& file) {
  if (const std::string format = file.text("format"); format != "palpate-model")
    file.fail("attribute format is \"" + format.substr(0, 40) + "\", expected \"palpate-model\"");
  if (const int version = file.integer("version"); version != kModelVersion)
    file.fail("version " + std::to_string(version) + " of the model file; this program reads version " +
              std::to_string(kModelVersion) + ": solve the organ again with palpate-solve");
  const std::string parameters = file.text("parameters");
  for (const Parameters kind : {Parameters::kDisplacement, Parameters::kForce, Parameters::kLevel})
    if (parameters == toString(kind)) return kind;
  file.fail("attribute parameters is \"" + parameters.substr(0, 40) +
            "\", expected \"displacement\", \"force\" or \"level\"");
}

/// What differs between the kinds.
void readKind(const ModelSource& file, ModelAttributes& a) {
  if (a.parameters == Parameters::kLevel) {
    file.numbers("load_direction", a.load_direction);
    a.load = file.number("load");
    return;
  }
  a.order = file.integer("order");
  a.force_order = file.integer("force_order");
  if (a.parameters == Parameters::kForce) a.reference_force = file.number("reference_force");
}

/// Empty without one. Programs parse it at their start, so its length is bounded.
std::string readCertificate(const ModelSource& file) {
  constexpr std::size_t kMostBytes = 65536;
  if (!file.hasAttribute("certificate")) return {};
  std::string text = file.text("certificate");
  if (text.size() > kMostBytes)
    file.fail("attribute certificate is " + std::to_string(text.size()) + " bytes, expected at most " +
              std::to_string(kMostBytes));
  return text;
}

ModelAttributes readAttributes(const ModelSource& file) {
  ModelAttributes a;
  a.parameters = readParameters(file);
  a.law = file.text("law");
  a.provenance = file.text("provenance");
  a.certificate = readCertificate(file);
  a.E = file.number("E");
  a.nu = file.number("nu");
  a.patch_radius = file.number("patch_radius");
  a.near_radius = file.number("near_radius");
  a.reference_displacement = file.number("reference_displacement");
  a.rounded_triangles = file.integer("rounded_triangles");
  readKind(file, a);
  return a;
}

StoredDigests readDigests(const ModelSource& file) {
  StoredDigests stored{file.text("digest"), file.text("provenance_digest"), {}, {}};
  if (!file.hasAttribute("certificate")) return stored;
  stored.certificate = file.text("certificate_digest");
  stored.certified = file.text("certificate_of");
  return stored;
}

std::uint64_t sizeOf(int order) {
  return static_cast<std::uint64_t>(MonomialBasis::size(order));
}

void readSurface(const ModelSource& file, Lengths& size, ModelView& v) {
  v.surface_positions = file.dataset(dataset::kSurfacePositions, size);
  v.surface_triangles = file.dataset(dataset::kSurfaceTriangles, size);
  v.surface_mesh_tag = file.dataset(dataset::kSurfaceMeshTag, size);
  v.position_of_node = file.dataset(dataset::kPositionOfNode, size);
}

void readLevels(const ModelSource& file, Lengths& size, ModelView& v) {
  constexpr std::uint64_t kMaxSteps = 100'000;
  v.levels_Z = file.dataset(dataset::kLevelsZ, size);
  v.level_functions = static_cast<std::size_t>(size.value("C"));
  const auto require = [&](const char* what, std::uint64_t found, std::uint64_t least, std::uint64_t most) {
    if (found < least || found > most)
      file.fail(dataset::kLevelsZ.name() + " has " + std::to_string(found) + what + ", expected " +
                std::to_string(least) + " to " + std::to_string(most));
  };
  require(" level functions", size.value("C"), 1, kMostLevelFunctions);
  require(" levels", size.value("L + 1"), 2, kMaxSteps + 1);
}

void readContact(const ModelSource& file, const ModelAttributes& a, Lengths& size, ModelView& v) {
  v.contact_node = file.dataset(dataset::kContactNode, size);
  v.contact_accessible = file.dataset(dataset::kContactAccessible, size);
  if (a.parameters == Parameters::kDisplacement) {
    size.define("Cf", sizeOf(a.force_order));
    v.contact_force = file.dataset(dataset::kContactForce, size);
    v.contact_stiffness = file.dataset(dataset::kContactStiffness, size);
    v.contact_series_radius = file.dataset(dataset::kContactSeriesRadius, size);
  } else {
    v.contact_displacement = file.dataset(dataset::kContactDisplacement, size);
  }
  v.contact_triangles = file.dataset(dataset::kContactTriangles, size);
  v.contact_domain_radius = file.dataset(dataset::kContactDomainRadius, size);
}

void readFields(const ModelSource& file, Lengths& size, ModelView& v) {
  size.define("3 Ns", 3 * size.value("Ns"));
  v.modes_X = file.wholeNumbers(dataset::kModesX, size);
  v.modes_X_scale = file.dataset(dataset::kModesXScale, size);
  v.modes_Y = file.wholeNumbers(dataset::kModesY, size);
  if (size.value("nY") > size.value("n"))
    file.fail(dataset::kModesY.name() + " has " + std::to_string(size.value("nY")) +
              " modes, expected at most n = " + std::to_string(size.value("n")));
  v.modes_Y_scale = file.dataset(dataset::kModesYScale, size);
  size.define("M + 1", size.value("M") + 1);
  v.near_offset = file.dataset(dataset::kNearOffset, size);
  v.near_node = file.dataset(dataset::kNearNode, size);
  size.define("3 Cm sum K", 3 * size.value("Cm") * size.value("sum K"));
  v.near_field = file.wholeNumbers(dataset::kNearField, size);
  v.near_scale = file.dataset(dataset::kNearScale, size);
}

void readGreens(const ModelSource& file, Lengths& size, ModelView& v) {
  v.green_node = file.dataset(dataset::kGreenNode, size);
  v.green_Y = file.wholeNumbers(dataset::kGreenY, size);
  v.green_Y_scale = file.dataset(dataset::kGreenYScale, size);
  size.define("G + 1", size.value("G") + 1);
  v.green_offset = file.dataset(dataset::kGreenOffset, size);
  v.green_near_node = file.dataset(dataset::kGreenNearNode, size);
  v.green_near = file.wholeNumbers(dataset::kGreenNear, size);
  v.green_near_scale = file.dataset(dataset::kGreenNearScale, size);
}

bool hasEdges(const ModelSource& file) {
  const std::array<const char*, 4> paths{dataset::kEdgeOffset.path, dataset::kEdgeNode.path,
                                         dataset::kEdgeField.path, dataset::kEdgeScale.path};
  return std::any_of(paths.begin(), paths.end(), [&](const char* path) { return file.hasDataset(path); });
}

void readEdges(const ModelSource& file, Lengths& size, ModelView& v) {
  v.edge_scale = file.dataset(dataset::kEdgeScale, size);
  size.define("E + 1", size.value("E") + 1);
  v.edge_offset = file.dataset(dataset::kEdgeOffset, size);
  v.edge_node = file.dataset(dataset::kEdgeNode, size);
  size.define("3 Ce sum Ke", 3 * size.value("Ce") * size.value("sum Ke"));
  v.edge_field = file.wholeNumbers(dataset::kEdgeField, size);
}

void readMesh(const ModelSource& file, Lengths& size, ModelView& v) {
  v.mesh_nodes = file.dataset(dataset::kMeshNodes, size);
  v.mesh_tetrahedra = file.dataset(dataset::kMeshTetrahedra, size);
  if (file.hasDataset(dataset::kMeshMidsides.path))
    v.mesh_midsides = file.dataset(dataset::kMeshMidsides, size);
  v.mesh_node_tag = file.dataset(dataset::kMeshNodeTag, size);
  v.mesh_tetrahedron_tag = file.dataset(dataset::kMeshTetrahedronTag, size);
  v.mesh_fixed = file.dataset(dataset::kMeshFixed, size);
  v.mesh_surface_node = file.dataset(dataset::kMeshSurfaceNode, size);
}

void readRegions(const ModelSource& file, Lengths& size, ModelView& v) {
  if (!file.hasDataset(dataset::kElementRegion.path) && !file.hasDataset(dataset::kRegionName.path)) return;
  v.mesh_element_region = file.dataset(dataset::kElementRegion, size);
  v.region_name = file.dataset(dataset::kRegionName, size);
  v.region_E = file.dataset(dataset::kRegionE, size);
  v.region_nu = file.dataset(dataset::kRegionNu, size);
  v.region_law = file.dataset(dataset::kRegionLaw, size);
  if (size.value("R") == 0) file.fail(dataset::kRegionName.name() + " is empty, expected regions");
}

void readSprings(const ModelSource& file, Lengths& size, ModelView& v) {
  if (!file.hasDataset(dataset::kSpringNode.path) && !file.hasDataset(dataset::kSpringStiffness.path)) return;
  v.spring_node = file.dataset(dataset::kSpringNode, size);
  v.spring_stiffness = file.dataset(dataset::kSpringStiffness, size);
  if (size.value("S") == 0) file.fail(dataset::kSpringNode.name() + " is empty, expected springs");
}

}  // namespace

ModelContents readModel(const ModelSource& file, const std::string& name) {
  ModelContents contents;
  ModelAttributes& a = contents.attributes;
  a = readAttributes(file);
  contents.stored = readDigests(file);
  checkAttributes(a, name);
  Lengths size;
  readSurface(file, size, contents.view);
  if (a.parameters == Parameters::kLevel)
    readLevels(file, size, contents.view);
  else
    size.define("C", sizeOf(a.order));
  size.define("Cm", modeCoefficients(a, size.value("C")));
  readContact(file, a, size, contents.view);
  readFields(file, size, contents.view);
  if (a.parameters == Parameters::kDisplacement) {
    readGreens(file, size, contents.view);
    if (hasEdges(file)) readEdges(file, size, contents.view);
  } else if (hasEdges(file)) {
    file.fail("has /edges, expected none in a model driven by " + std::string(toString(a.parameters)));
  }
  readMesh(file, size, contents.view);
  readRegions(file, size, contents.view);
  readSprings(file, size, contents.view);
  contents.copies = file.copies();
  return contents;
}

}  // namespace palpate
