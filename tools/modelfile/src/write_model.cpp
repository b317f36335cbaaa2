// SPDX-License-Identifier: Apache-2.0
#include "palpate/modelfile/write_model.h"

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "check_sizes.h"
#include "palpate/core/datasets.h"
#include "palpate/core/hdf5_handle.h"
#include "palpate/core/multi_index.h"
#include "palpate/core/packed_modes.h"
#include "palpate/program/write_file.h"

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

std::string groupOf(const std::string& path) {
  return path.substr(0, path.find('/'));
}

void makeGroup(const Hdf5Handle& file, const std::string& name) {
  const Hdf5Handle group(H5Gcreate2(file.get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                         H5Gclose);
  require(group.valid(), name);
}

void makeGroups(const Hdf5Handle& file) {
  for (const char* path : {dataset::kSurfacePositions.path, dataset::kContactNode.path, dataset::kModesX.path,
                           dataset::kNearNode.path, dataset::kMeshNodes.path})
    makeGroup(file, groupOf(path));
}

/// Lengths by the symbols of datasets.h.
using Lengths = std::map<std::string_view, hsize_t>;

hsize_t lengthOf(std::string_view symbol, const Lengths& lengths) {
  hsize_t number = 0;
  const auto [end, error] = std::from_chars(symbol.data(), symbol.data() + symbol.size(), number);
  return error == std::errc() && end == symbol.data() + symbol.size() ? number : lengths.at(symbol);
}

template <typename T>
void writeDataset(const Hdf5Handle& file, const Dataset<T>& what, const std::vector<T>& values,
                  const Lengths& lengths) {
  const char* const name = what.path;
  Shape shape;
  for (const char* symbol : what.shape)
    if (symbol != nullptr) shape.push_back(lengthOf(symbol, lengths));
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
void writeContact(const Hdf5Handle& file, const ModelData& d, const Lengths& size) {
  writeDataset(file, dataset::kContactNode, d.contact_node, size);
  writeDataset(file, dataset::kContactAccessible, d.contact_accessible, size);
  writeDataset(file, dataset::kContactDomainRadius, d.contact_domain_radius, size);
  if (d.attributes.parameters == Parameters::kDisplacement)
    return writeDataset(file, dataset::kContactForce, d.contact_force, size);
  writeDataset(file, dataset::kContactDisplacement, d.contact_displacement, size);
  if (d.attributes.parameters != Parameters::kLevel) return;
  makeGroup(file, groupOf(dataset::kLevelsZ.path));
  writeDataset(file, dataset::kLevelsZ, d.levels_Z, size);
}

/// Modes in mixed precision, where there are any.
void writePacked(const Hdf5Handle& file, const ModelData& d, const Lengths& size) {
  const PackedModesData& packed = d.modes_packed;
  if (packed.view().empty()) return;
  writeDataset(file, dataset::kModesInt16, packed.X16, size);
  writeDataset(file, dataset::kModesBytes, packed.X8, size);
  writeDataset(file, dataset::kModesScale, packed.scale, size);
  writeDataset(file, dataset::kModesKinds, packed.kinds, size);
}

Lengths lengthsOf(const ModelData& d) {
  const hsize_t Ns = d.surface_mesh_tag.size(), M = d.contact_node.size(), C = fieldCoefficients(d);
  Lengths size{{"Ns", Ns},
               {"3 Ns", 3 * Ns},
               {"T", d.surface_triangles.size() / 3},
               {"M", M},
               {"M + 1", M + 1},
               {"C", C},
               {"L + 1", d.levels_Z.size() / C},
               {"n", modeCount(d)},
               {"kinds", kPackedKinds},
               {"tile", kTile},
               {"sum K", d.near_node.size()},
               {"3 C sum K", d.near_field.size()},
               {"N", d.mesh_node_tag.size()},
               {"V", d.mesh_tetrahedron_tag.size()},
               {"F", d.mesh_fixed.size()}};
  if (d.attributes.parameters == Parameters::kDisplacement)
    size["Cf"] = static_cast<hsize_t>(MonomialBasis::size(forceOrder(d.attributes)));
  if (d.modes_packed.view().empty()) return size;
  const ModeCounts counts = countModes(d.modes_packed.view(), modeCount(d));
  size["tiles"] = d.modes_packed.tiles;
  size["pairs"] = counts.pairs();
  size["quads"] = counts.quads();
  size["packed"] = counts.packed();
  return size;
}

void writeDatasets(const Hdf5Handle& file, const ModelData& d) {
  const Lengths size = lengthsOf(d);
  writeDataset(file, dataset::kSurfacePositions, d.surface_positions, size);
  writeDataset(file, dataset::kSurfaceTriangles, d.surface_triangles, size);
  writeDataset(file, dataset::kSurfaceMeshTag, d.surface_mesh_tag, size);
  writeDataset(file, dataset::kPositionOfNode, d.position_of_node, size);
  writeContact(file, d, size);
  writeDataset(file, dataset::kModesX, d.modes_X, size);
  writeDataset(file, dataset::kModesY, d.modes_Y, size);
  writePacked(file, d, size);
  writeDataset(file, dataset::kNearOffset, d.near_offset, size);
  writeDataset(file, dataset::kNearNode, d.near_node, size);
  writeDataset(file, dataset::kNearField, d.near_field, size);
  writeDataset(file, dataset::kMeshNodes, d.mesh_nodes, size);
  writeDataset(file, dataset::kMeshTetrahedra, d.mesh_tetrahedra, size);
  writeDataset(file, dataset::kMeshNodeTag, d.mesh_node_tag, size);
  writeDataset(file, dataset::kMeshTetrahedronTag, d.mesh_tetrahedron_tag, size);
  writeDataset(file, dataset::kMeshFixed, d.mesh_fixed, size);
  writeDataset(file, dataset::kMeshSurfaceNode, d.mesh_surface_node, size);
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
  program::FileBeside beside(path);
  try {
    writeAll(beside.path(), data);
    beside.takePlace();
    sync(path.has_parent_path() ? path.parent_path().string() : ".");
  } catch (const program::WriteError& error) {
    throw ModelFileError(path.string() + ": cannot be written: " + error.reason());
  } catch (const ModelFileError& error) {
    throw ModelFileError(path.string() + ": " + error.what());
  }
}

}  // namespace palpate::modelfile
