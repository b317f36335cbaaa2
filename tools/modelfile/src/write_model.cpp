// SPDX-License-Identifier: Apache-2.0
#include "palpate/modelfile/write_model.h"

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "check_sizes.h"
#include "palpate/core/hdf5_handle.h"
#include "palpate/core/multi_index.h"
#include "palpate/core/packed_modes.h"

namespace palpate::modelfile {

namespace {

using Shape = std::vector<hsize_t>;

constexpr hsize_t kAlignment = 4096;

hid_t fileType(double) {
  return H5T_IEEE_F64LE;
}
hid_t fileType(float) {
  return H5T_IEEE_F32LE;
}
hid_t fileType(std::int16_t) {
  return H5T_STD_I16LE;
}
hid_t fileType(std::int32_t) {
  return H5T_STD_I32LE;
}
hid_t fileType(std::int64_t) {
  return H5T_STD_I64LE;
}
hid_t fileType(std::uint8_t) {
  return H5T_STD_U8LE;
}
hid_t memoryType(double) {
  return H5T_NATIVE_DOUBLE;
}
hid_t memoryType(float) {
  return H5T_NATIVE_FLOAT;
}
hid_t memoryType(std::int16_t) {
  return H5T_NATIVE_INT16;
}
hid_t memoryType(std::int32_t) {
  return H5T_NATIVE_INT32;
}
hid_t memoryType(std::int64_t) {
  return H5T_NATIVE_INT64;
}
hid_t memoryType(std::uint8_t) {
  return H5T_NATIVE_UINT8;
}

void require(bool good, const std::string& what) {
  if (!good) throw ModelFileError("cannot write " + what);
}

/// Creates the temporary file, all of whose objects begin on a page.
Hdf5Handle createFile(const std::string& path) {
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  require(access.valid() && H5Pset_alignment(access.get(), 0, kAlignment) >= 0, path);
  Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
  require(file.valid(), path);
  return file;
}

void makeGroup(const Hdf5Handle& file, const char* name) {
  const Hdf5Handle group(H5Gcreate2(file.get(), name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  require(group.valid(), name);
}

void makeGroups(const Hdf5Handle& file) {
  for (const char* name : {"surface", "contact", "modes", "near", "mesh"}) makeGroup(file, name);
}

template <typename T>
void writeDataset(const Hdf5Handle& file, const char* name, const std::vector<T>& values,
                  const Shape& shape) {
  const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  require(space.valid() && creation.valid(), name);
  H5Pset_layout(creation.get(), H5D_CONTIGUOUS);
  H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER);  // every number is written below
  const Hdf5Handle dataset(
      H5Dcreate2(file.get(), name, fileType(T{}), space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
      H5Dclose);
  require(dataset.valid(), name);
  if (values.empty()) return;
  require(H5Dwrite(dataset.get(), memoryType(T{}), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, name);
}

template <typename T>
void writeNumber(const Hdf5Handle& file, const char* name, T value) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(
      H5Acreate2(file.get(), name, fileType(T{}), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(attribute.valid() && H5Awrite(attribute.get(), memoryType(T{}), &value) >= 0, name);
}

void writeNumbers(const Hdf5Handle& file, const char* name, std::span<const double> values) {
  const hsize_t count = values.size();
  const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Hdf5Handle attribute(
      H5Acreate2(file.get(), name, fileType(double{}), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(attribute.valid() && H5Awrite(attribute.get(), memoryType(double{}), values.data()) >= 0, name);
}

/// Variable length, so that a long provenance does not meet the 64 KiB limit of an object header.
void writeText(const Hdf5Handle& file, const char* name, const std::string& text) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  require(type.valid() && H5Tset_size(type.get(), H5T_VARIABLE) >= 0, name);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  const Hdf5Handle attribute(H5Acreate2(file.get(), name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  const char* const start = text.c_str();
  require(attribute.valid() && H5Awrite(attribute.get(), type.get(), &start) >= 0, name);
}

/// What differs between the kinds.
void writeKind(const Hdf5Handle& file, const ModelAttributes& a) {
  if (a.parameters != Parameters::kDisplacement)
    writeText(file, "parameters", std::string(toString(a.parameters)));
  if (a.parameters == Parameters::kLevel) {
    writeNumbers(file, "load_direction", a.load_direction);
    writeNumber(file, "load", a.load);
    return;
  }
  writeNumber(file, "order", std::int32_t{a.order});
  writeNumber(file, "force_order", std::int32_t{forceOrder(a)});
  if (a.parameters == Parameters::kForce) writeNumber(file, "reference_force", a.reference_force);
}

void writeAttributes(const Hdf5Handle& file, const ModelAttributes& a) {
  writeText(file, "format", "palpate-model");
  writeNumber(file, "version", std::int32_t{a.parameters == Parameters::kDisplacement ? 1 : 2});
  writeText(file, "model_id", a.model_id);
  writeText(file, "law", a.law);
  writeNumber(file, "E", a.E);
  writeNumber(file, "nu", a.nu);
  writeNumber(file, "patch_radius", a.patch_radius);
  writeNumber(file, "near_radius", a.near_radius);
  writeNumber(file, "reference_displacement", a.reference_displacement);
  writeText(file, "provenance", a.provenance);
  writeKind(file, a);
}

/// The contact's answer, of one kind or the other, and the level functions.
void writeContact(const Hdf5Handle& file, const ModelData& d, hsize_t M, hsize_t C) {
  writeDataset(file, "contact/node", d.contact_node, {M});
  writeDataset(file, "contact/accessible", d.contact_accessible, {M});
  writeDataset(file, "contact/domain_radius", d.contact_domain_radius, {M});
  if (d.attributes.parameters == Parameters::kDisplacement) {
    const hsize_t Cf = static_cast<hsize_t>(MonomialBasis::size(forceOrder(d.attributes)));
    return writeDataset(file, "contact/force", d.contact_force, {M, Cf, 3});
  }
  writeDataset(file, "contact/displacement", d.contact_displacement, {M, C, 3});
  if (d.attributes.parameters != Parameters::kLevel) return;
  makeGroup(file, "levels");
  writeDataset(file, "levels/Z", d.levels_Z, {C, d.levels_Z.size() / C});
}

/// Modes in mixed precision, where there are any.
void writePacked(const Hdf5Handle& file, const ModelData& d) {
  const PackedModesData& packed = d.modes_packed;
  if (packed.view().empty()) return;
  const ModeCounts counts = countModes(packed.view(), modeCount(d));
  writeDataset(file, "modes/int16", packed.X16, {packed.tiles, counts.pairs(), kTile, 2});
  writeDataset(file, "modes/bytes", packed.X8, {packed.tiles, counts.quads(), kTile, 4});
  writeDataset(file, "modes/scale", packed.scale, {counts.packed()});
  writeDataset(file, "modes/kinds", packed.kinds, {kPackedKinds});
}

void writeDatasets(const Hdf5Handle& file, const ModelData& d) {
  const hsize_t Ns = d.surface_mesh_tag.size(), M = d.contact_node.size();
  const hsize_t C = fieldCoefficients(d);
  const hsize_t n = modeCount(d);
  writeDataset(file, "surface/positions", d.surface_positions, {Ns, 3});
  writeDataset(file, "surface/triangles", d.surface_triangles, {d.surface_triangles.size() / 3, 3});
  writeDataset(file, "surface/mesh_tag", d.surface_mesh_tag, {Ns});
  writeDataset(file, "surface/position_of_node", d.position_of_node, {Ns});
  writeContact(file, d, M, C);
  writeDataset(file, "modes/X", d.modes_X, {n, 3 * Ns});
  writeDataset(file, "modes/Y", d.modes_Y, {M, C, n});
  writePacked(file, d);
  writeDataset(file, "near/offset", d.near_offset, {M + 1});
  writeDataset(file, "near/node", d.near_node, {d.near_node.size()});
  writeDataset(file, "near/field", d.near_field, {d.near_field.size()});
  writeDataset(file, "mesh/nodes", d.mesh_nodes, {d.mesh_node_tag.size(), 3});
  writeDataset(file, "mesh/tetrahedra", d.mesh_tetrahedra, {d.mesh_tetrahedron_tag.size(), 4});
  writeDataset(file, "mesh/node_tag", d.mesh_node_tag, {d.mesh_node_tag.size()});
  writeDataset(file, "mesh/tetrahedron_tag", d.mesh_tetrahedron_tag, {d.mesh_tetrahedron_tag.size()});
  writeDataset(file, "mesh/fixed", d.mesh_fixed, {d.mesh_fixed.size()});
  writeDataset(file, "mesh/surface_node", d.mesh_surface_node, {Ns});
}

/// The data have to be on the disk before the name points to them: else a crash could leave a name without a
/// model.
void sync(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool good = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!good) throw ModelFileError(path + " cannot be synced: " + std::strerror(error));
}

void writeAll(const std::string& path, const ModelData& data) {
  Hdf5Handle file = createFile(path);
  makeGroups(file);
  writeAttributes(file, data.attributes);
  writeDatasets(file, data);
  require(file.closeNow(), path);
  sync(path);
}

}  // namespace

void writeModel(const std::filesystem::path& path, const ModelData& data) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors leave as exceptions, not as HDF5's own print-out
  checkSizes(data);
  const std::string temporary = path.string() + ".tmp-" + std::to_string(::getpid());
  try {
    writeAll(temporary, data);
    std::filesystem::rename(temporary, path);
    sync(path.has_parent_path() ? path.parent_path().string() : ".");
  } catch (const std::filesystem::filesystem_error& error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw ModelFileError(path.string() + ": cannot be written: " + error.code().message());
  } catch (const ModelFileError& error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw ModelFileError(path.string() + ": " + error.what());
  }
}

}  // namespace palpate::modelfile
