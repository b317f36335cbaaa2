// SPDX-License-Identifier: Apache-2.0
#include "core/data/model_reader.h"

#include <algorithm>
#include <array>

#include "core/base/multi_index.h"
#include "core/data/datasets.h"
#include "core/data/hdf5_reader.h"
#include "core/data/model_checks.h"
#include "core/data/packed_modes.h"

namespace palpate {

namespace {

/// Version 1 is the displacement-driven model, version 2 the load-driven ones.
Parameters readParameters(const Hdf5Reader& file) {
  if (const std::string format = file.text("format"); format != "palpate-model")
    file.fail("attribute format is \"" + format.substr(0, 40) + "\", expected \"palpate-model\"");
  const int version = file.integer("version");
  if (version == 1) return Parameters::kDisplacement;
  if (version != 2) file.fail("attribute version is " + std::to_string(version) + ", expected 1 or 2");
  const std::string parameters = file.text("parameters");
  for (const Parameters kind : {Parameters::kForce, Parameters::kLevel})
    if (parameters == toString(kind)) return kind;
  file.fail("attribute parameters is \"" + parameters.substr(0, 40) + "\", expected \"force\" or \"level\"");
}

/// What differs between the kinds.
void readKind(const Hdf5Reader& file, ModelAttributes& a) {
  if (a.parameters == Parameters::kLevel) {
    file.numbers("load_direction", a.load_direction);
    a.load = file.number("load");
    return;
  }
  a.order = file.integer("order");
  const bool force_order = a.parameters == Parameters::kDisplacement || file.hasAttribute("force_order");
  a.force_order = force_order ? file.integer("force_order") : a.order;
  if (a.parameters == Parameters::kForce) a.reference_force = file.number("reference_force");
}

ModelAttributes readAttributes(const Hdf5Reader& file) {
  ModelAttributes a;
  a.parameters = readParameters(file);
  a.law = file.text("law");
  a.provenance = file.text("provenance");
  a.E = file.number("E");
  a.nu = file.number("nu");
  a.patch_radius = file.number("patch_radius");
  a.near_radius = file.number("near_radius");
  a.reference_displacement = file.number("reference_displacement");
  readKind(file, a);
  return a;
}

StoredDigests readDigests(const Hdf5Reader& file) {
  for (const char* attribute : {"digest", "provenance_digest"})
    if (!file.hasAttribute(attribute))
      file.fail(std::string("attribute ") + attribute +
                " is missing: the file is of an earlier palpate-solve, solve the model again");
  return {file.text("digest"), file.text("provenance_digest")};
}

std::uint64_t sizeOf(int order) {
  return static_cast<std::uint64_t>(MonomialBasis::size(order));
}

void readSurface(const Hdf5Reader& file, Lengths& size, ModelView& v) {
  v.surface_positions = file.dataset(dataset::kSurfacePositions, size);
  v.surface_triangles = file.dataset(dataset::kSurfaceTriangles, size);
  v.surface_mesh_tag = file.dataset(dataset::kSurfaceMeshTag, size);
  v.position_of_node = file.dataset(dataset::kPositionOfNode, size);
}

void readLevels(const Hdf5Reader& file, Lengths& size, ModelView& v) {
  constexpr std::uint64_t kMaxSteps = 100'000;
  v.levels_Z = file.dataset(dataset::kLevelsZ, size);
  v.level_functions = static_cast<std::size_t>(size.value("C"));
  const auto require = [&](const char* what, std::uint64_t found, std::uint64_t least, std::uint64_t most) {
    if (found < least || found > most)
      file.fail(dataset::kLevelsZ.name() + " has " + std::to_string(found) + what + ", expected " +
                std::to_string(least) + " to " + std::to_string(most));
  };
  require(" level functions", size.value("C"), 1, MonomialBasis::kMaxCoefficients);
  require(" levels", size.value("L + 1"), 2, kMaxSteps + 1);
}

void readContact(const Hdf5Reader& file, const ModelAttributes& a, Lengths& size, ModelView& v) {
  v.contact_node = file.dataset(dataset::kContactNode, size);
  v.contact_accessible = file.dataset(dataset::kContactAccessible, size);
  if (a.parameters == Parameters::kDisplacement) {
    size.define("Cf", sizeOf(a.force_order));
    v.contact_force = file.dataset(dataset::kContactForce, size);
  } else {
    v.contact_displacement = file.dataset(dataset::kContactDisplacement, size);
  }
  v.contact_domain_radius = file.dataset(dataset::kContactDomainRadius, size);
}

/// How many modes are packed in each way, none of them more than there are.
std::uint64_t readKinds(const Hdf5Reader& file, Lengths& size, PackedModes& packed) {
  size.define("kinds", kPackedKinds);
  packed.kinds = file.dataset(dataset::kModesKinds, size);
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < kPackedKinds; ++k) {
    if (packed.kinds[k] < 0)
      file.fail(dataset::kModesKinds.name() + " number " + std::to_string(k) + " is " +
                std::to_string(packed.kinds[k]) + ", expected at least 0");
    sum += packed.kinds[k];
  }
  if (static_cast<std::uint64_t>(sum) > size.value("n"))
    file.fail(dataset::kModesKinds.name() + " adds up to " + std::to_string(sum) + ", expected at most " +
              size["n"].text());
  return static_cast<std::uint64_t>(sum);
}

/// Modes in mixed precision, of files that have them.
void readPacked(const Hdf5Reader& file, Lengths& size, PackedModes& packed) {
  const auto has = [&](const char* path) { return file.hasDataset(path); };
  for (const char* old : {"modes/X16", "modes/X8", "modes/scale16", "modes/scale8"})  // never released
    if (has(old))
      file.fail(std::string("/") + old + " is a storage of modes that is no longer read, expected " +
                dataset::kModesInt16.name() + ", bytes, scale and kinds: solve the model again");
  constexpr std::array kAll{dataset::kModesKinds.path, dataset::kModesScale.path, dataset::kModesInt16.path,
                            dataset::kModesBytes.path};  // or none of them
  if (std::none_of(kAll.begin(), kAll.end(), has)) return;
  size.define("packed", readKinds(file, size, packed));
  packed.scale = file.dataset(dataset::kModesScale, size);
  const ModeCounts counts = countModes(packed, static_cast<std::size_t>(size.value("n")));
  size.define("pairs", counts.pairs());
  size.define("quads", counts.quads());
  size.define("tile", kTile);
  packed.X16 = file.dataset(dataset::kModesInt16, size);
  packed.X8 = file.dataset(dataset::kModesBytes, size);
  const std::size_t most = tilesOf(3 * size.value("Ns"));
  if (size.value("tiles") > most)
    file.fail(dataset::kModesInt16.name() + " has " + size["tiles"].text() + ", expected at most " +
              std::to_string(most));
  packed.tiles = static_cast<std::size_t>(size.value("tiles"));
}

void readFields(const Hdf5Reader& file, Lengths& size, ModelView& v) {
  size.define("3 Ns", 3 * size.value("Ns"));
  v.modes_X = file.dataset(dataset::kModesX, size);
  v.modes_Y = file.dataset(dataset::kModesY, size);
  readPacked(file, size, v.modes_packed);
  size.define("M + 1", size.value("M") + 1);
  v.near_offset = file.dataset(dataset::kNearOffset, size);
  v.near_node = file.dataset(dataset::kNearNode, size);
  size.define("3 C sum K", 3 * size.value("C") * size.value("sum K"));
  v.near_field = file.dataset(dataset::kNearField, size);
}

void readMesh(const Hdf5Reader& file, Lengths& size, ModelView& v) {
  v.mesh_nodes = file.dataset(dataset::kMeshNodes, size);
  v.mesh_tetrahedra = file.dataset(dataset::kMeshTetrahedra, size);
  v.mesh_node_tag = file.dataset(dataset::kMeshNodeTag, size);
  v.mesh_tetrahedron_tag = file.dataset(dataset::kMeshTetrahedronTag, size);
  v.mesh_fixed = file.dataset(dataset::kMeshFixed, size);
  v.mesh_surface_node = file.dataset(dataset::kMeshSurfaceNode, size);
}

}  // namespace

ModelContents readModel(const SealedImage& image, const std::string& name) {
  const Hdf5Reader file(image, name);
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
  readContact(file, a, size, contents.view);
  readFields(file, size, contents.view);
  readMesh(file, size, contents.view);
  return contents;
}

}  // namespace palpate
