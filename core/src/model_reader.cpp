// SPDX-License-Identifier: Apache-2.0
#include "model_reader.h"

#include <algorithm>
#include <array>

#include "hdf5_reader.h"
#include "model_checks.h"
#include "palpate/core/multi_index.h"
#include "palpate/core/packed_modes.h"

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
  a.model_id = file.text("model_id");
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

/// Symbols that more than one dataset has in its shape.
struct Lengths {
  Length Ns{"Ns"}, M{"M"}, n{"n"}, C{"C"}, three{3};
};

Length sizeOf(int order) {
  return {static_cast<std::uint64_t>(MonomialBasis::size(order))};
}

void readSurface(const Hdf5Reader& file, Lengths& size, ModelView& v) {
  Length T("T");
  v.surface_positions = file.dataset<double>("surface/positions", {&size.Ns, &size.three});
  v.surface_triangles = file.dataset<std::int32_t>("surface/triangles", {&T, &size.three});
  v.surface_mesh_tag = file.dataset<std::int64_t>("surface/mesh_tag", {&size.Ns});
  v.position_of_node = file.dataset<std::int32_t>("surface/position_of_node", {&size.Ns});
}

void readLevels(const Hdf5Reader& file, Lengths& size, ModelView& v) {
  Length points("L + 1");
  v.levels_Z = file.dataset<double>("levels/Z", {&size.C, &points});
  v.level_functions = static_cast<std::size_t>(size.C.value);
}

void readContact(const Hdf5Reader& file, const ModelAttributes& a, Lengths& size, ModelView& v) {
  v.contact_node = file.dataset<std::int32_t>("contact/node", {&size.M});
  v.contact_accessible = file.dataset<std::uint8_t>("contact/accessible", {&size.M});
  if (a.parameters == Parameters::kDisplacement) {
    Length Cf = sizeOf(a.force_order);
    v.contact_force = file.dataset<double>("contact/force", {&size.M, &Cf, &size.three});
  } else {
    v.contact_displacement = file.dataset<double>("contact/displacement", {&size.M, &size.C, &size.three});
  }
  v.contact_domain_radius = file.dataset<double>("contact/domain_radius", {&size.M});
}

/// How many modes are packed in each way, none of them more than there are.
std::uint64_t readKinds(const Hdf5Reader& file, const Lengths& size, PackedModes& packed) {
  Length kinds(kPackedKinds);
  packed.kinds = file.dataset<std::int32_t>("modes/kinds", {&kinds});
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < kPackedKinds; ++k) {
    if (packed.kinds[k] < 0)
      file.fail("/modes/kinds number " + std::to_string(k) + " is " + std::to_string(packed.kinds[k]) +
                ", expected at least 0");
    sum += packed.kinds[k];
  }
  if (static_cast<std::uint64_t>(sum) > size.n.value)
    file.fail("/modes/kinds adds up to " + std::to_string(sum) + ", expected at most " + size.n.text());
  return static_cast<std::uint64_t>(sum);
}

/// Modes in mixed precision, of files that have them.
void readPacked(const Hdf5Reader& file, const Lengths& size, PackedModes& packed) {
  const auto has = [&](const char* dataset) { return file.hasDataset(dataset); };
  for (const char* old : {"modes/X16", "modes/X8", "modes/scale16", "modes/scale8"})  // never released
    if (has(old))
      file.fail(std::string("/") + old +
                " is a storage of modes that is no longer read, expected /modes/int16, " +
                "bytes, scale and kinds: solve the model again");
  constexpr std::array kAll{"modes/kinds", "modes/scale", "modes/int16", "modes/bytes"};  // or none of them
  if (std::none_of(kAll.begin(), kAll.end(), has)) return;
  Length tiles("tiles"), tile(kTile), two(2), four(4), all(readKinds(file, size, packed));
  packed.scale = file.dataset<float>("modes/scale", {&all});
  const ModeCounts counts = countModes(packed, static_cast<std::size_t>(size.n.value));
  Length pairs(counts.pairs()), quads(counts.quads());
  packed.X16 = file.dataset<std::int16_t>("modes/int16", {&tiles, &pairs, &tile, &two});
  packed.X8 = file.dataset<std::uint8_t>("modes/bytes", {&tiles, &quads, &tile, &four});
  if (tiles.value > tilesOf(3 * size.Ns.value))
    file.fail("/modes/int16 has " + tiles.text() + ", expected at most " +
              std::to_string(tilesOf(3 * size.Ns.value)));
  packed.tiles = static_cast<std::size_t>(tiles.value);
}

void readFields(const Hdf5Reader& file, Lengths& size, ModelView& v) {
  Length components(3 * size.Ns.value), offsets(size.M.value + 1), near("sum K");
  v.modes_X = file.dataset<float>("modes/X", {&size.n, &components});
  v.modes_Y = file.dataset<float>("modes/Y", {&size.M, &size.C, &size.n});
  readPacked(file, size, v.modes_packed);
  v.near_offset = file.dataset<std::int64_t>("near/offset", {&offsets});
  v.near_node = file.dataset<std::int32_t>("near/node", {&near});
  Length field(3 * size.C.value * near.value);
  v.near_field = file.dataset<float>("near/field", {&field});
}

void readMesh(const Hdf5Reader& file, Lengths& size, ModelView& v) {
  Length N("N"), V("V"), fixed("F"), four(4);
  v.mesh_nodes = file.dataset<double>("mesh/nodes", {&N, &size.three});
  v.mesh_tetrahedra = file.dataset<std::int32_t>("mesh/tetrahedra", {&V, &four});
  v.mesh_node_tag = file.dataset<std::int64_t>("mesh/node_tag", {&N});
  v.mesh_tetrahedron_tag = file.dataset<std::int64_t>("mesh/tetrahedron_tag", {&V});
  v.mesh_fixed = file.dataset<std::int32_t>("mesh/fixed", {&fixed});
  v.mesh_surface_node = file.dataset<std::int32_t>("mesh/surface_node", {&size.Ns});
}

}  // namespace

ModelContents readModel(const SealedImage& image, const std::string& name) {
  const Hdf5Reader file(image, name);
  ModelContents contents;
  ModelAttributes& a = contents.attributes;
  a = readAttributes(file);
  checkAttributes(a, name);
  Lengths size;
  readSurface(file, size, contents.view);
  if (a.parameters == Parameters::kLevel)
    readLevels(file, size, contents.view);
  else
    size.C = sizeOf(a.order);
  readContact(file, a, size, contents.view);
  readFields(file, size, contents.view);
  readMesh(file, size, contents.view);
  return contents;
}

}  // namespace palpate
