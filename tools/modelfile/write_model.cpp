// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/write_model.h"

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "core/data/datasets.h"
#include "core/data/hdf5_handle.h"
#include "core/data/model_content.h"
#include "tools/modelfile/check_sizes.h"
#include "tools/modelfile/pack_fields.h"
#include "tools/program/write_file.h"

namespace palpate::modelfile {

namespace {

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

void makeGroups(const Hdf5Handle& file, const ModelAttributes& attributes) {
  for (const char* path : {dataset::kSurfacePositions.path, dataset::kContactNode.path, dataset::kModesX.path,
                           dataset::kNearNode.path, dataset::kMeshNodes.path})
    makeGroup(file, groupOf(path));
  if (attributes.parameters == Parameters::kLevel) makeGroup(file, groupOf(dataset::kLevelsZ.path));
}

template <typename T>
void writeDataset(const Hdf5Handle& file, const Dataset<T>& what, std::span<const T> values,
                  const LengthTable& lengths) {
  const char* const name = what.path;
  const std::vector<std::uint64_t> numbers = shapeOf(what.shape, lengths);
  const std::vector<hsize_t> shape(numbers.begin(), numbers.end());
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

/// Writes an attribute by its type.
struct AttributeWriter {
  const Hdf5Handle& file;
  void operator()(const char* name, const std::string& text) const { writeText(file, name, text); }
  void operator()(const char* name, const std::array<double, 3>& values) const {
    writeNumbers(file, name, values);
  }
  template <class T>
  void operator()(const char* name, T value) const {
    writeNumber(file, name, value);
  }
};

void writeContent(const Hdf5Handle& file, const ModelAttributes& a, const ModelView& v) {
  const LengthTable lengths = lengthsOf(a, v);
  forEachAttribute(a, AttributeWriter{file});
  forEachDataset(a, v, [&]<class T>(const Dataset<T>& what, std::span<const T> values) {
    writeDataset(file, what, values, lengths);
  });
  writeText(file, "digest", contentDigest(a, v).hex());
}

void writeProvenance(const Hdf5Handle& file, const std::string& text) {
  writeText(file, "provenance", text);
  writeText(file, "provenance_digest", sha256(std::as_bytes(std::span<const char>(text))).hex());
}

ModelView viewOf(const ModelData& d, const PackedFields& fields) {
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
  if (d.attributes.parameters == Parameters::kLevel) v.level_functions = fieldCoefficients(d);
  v.modes_X = fields.X.whole;
  v.modes_X_scale = fields.X.scale;
  v.modes_Y = fields.Y.whole;
  v.modes_Y_scale = fields.Y.scale;
  v.near_offset = d.near_offset;
  v.near_node = d.near_node;
  v.near_field = fields.near.whole;
  v.near_scale = fields.near.scale;
  v.mesh_nodes = d.mesh_nodes;
  v.mesh_tetrahedra = d.mesh_tetrahedra;
  v.mesh_node_tag = d.mesh_node_tag;
  v.mesh_tetrahedron_tag = d.mesh_tetrahedron_tag;
  v.mesh_fixed = d.mesh_fixed;
  v.mesh_surface_node = d.mesh_surface_node;
  return v;
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
  ModelAttributes attributes = data.attributes;
  attributes.force_order = forceOrder(attributes);
  makeGroups(file, attributes);
  const PackedFields fields = packFields(data);
  writeContent(file, attributes, viewOf(data, fields));
  writeProvenance(file, attributes.provenance);
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
