// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/write_model.h"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/data/datasets.h"
#include "core/data/hdf5_handle.h"
#include "core/data/model_content.h"
#include "tools/modelfile/check_sizes.h"
#include "tools/modelfile/file_parts.h"
#include "tools/modelfile/pack_fields.h"
#include "tools/modelfile/stored_types.h"
#include "tools/program/write_file.h"

namespace palpate::modelfile {

namespace {

/// Creates the temporary file.
Hdf5Handle createFile(const std::string& path) {
  Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, aligned().get()), H5Fclose);
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

void makeGroups(const Hdf5Handle& file, const ModelAttributes& attributes, const ModelView& view) {
  for (const char* path : {dataset::kSurfacePositions.path, dataset::kContactNode.path, dataset::kModesX.path,
                           dataset::kNearNode.path, dataset::kMeshNodes.path})
    makeGroup(file, groupOf(path));
  if (attributes.parameters == Parameters::kLevel) makeGroup(file, groupOf(dataset::kLevelsZ.path));
  if (attributes.parameters == Parameters::kDisplacement) makeGroup(file, groupOf(dataset::kGreenNode.path));
  if (!view.edge_offset.empty()) makeGroup(file, groupOf(dataset::kEdgeNode.path));
  if (!view.region_name.empty()) makeGroup(file, groupOf(dataset::kRegionName.path));
  if (!view.spring_node.empty()) makeGroup(file, groupOf(dataset::kSpringNode.path));
}

template <typename T, class Numbers>
void writeDataset(const Hdf5Handle& file, const Dataset<T>& what, const Numbers& values,
                  const LengthTable& lengths, bool compact) {
  const char* const name = what.path;
  const std::vector<std::uint64_t> numbers = shapeOf(what.shape, lengths);
  const std::vector<hsize_t> shape(numbers.begin(), numbers.end());
  const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  require(space.valid() && creation.valid(), name);
  H5Pset_layout(creation.get(), H5D_CONTIGUOUS);
  H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER);  // every number is written below
  const Hdf5Handle type = typeInMemory(values),
                   stored = asStored(values, compact, [](const auto&number) { return typeOf(number); });
  const Hdf5Handle dataset(
      H5Dcreate2(file.get(), name, stored.get(), space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
      H5Dclose);
  require(dataset.valid(), name);
  if (values.empty()) return;
  require(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, placeOf(values)) >= 0, name);
}

template <typename T>
void writeNumber(const Hdf5Handle& file, const char* name, T value) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle type = typeOf(T{});
  const Hdf5Handle attribute(H5Acreate2(file.get(), name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  require(attribute.valid() && H5Awrite(attribute.get(), type.get(), &value) >= 0, name);
}

void writeNumbers(const Hdf5Handle& file, const char* name, std::span<const double> values) {
  const hsize_t count = values.size();
  const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Hdf5Handle attribute(
      H5Acreate2(file.get(), name, H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(attribute.valid() && H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, values.data()) >= 0, name);
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

void writeContent(const Hdf5Handle& file, const ModelAttributes& a, const ModelView& v, bool compact) {
  const LengthTable lengths = lengthsOf(a, v);
  forEachAttribute(a, AttributeWriter{file});
  forEachDataset(a, v, [&](const auto& what, const auto& values) {
    writeDataset(file, what, values, lengths, compact);
  });
  const std::string digest = contentDigest(a, v).hex();
  writeText(file, "digest", digest);
  writeWithDigest(file, "provenance", a.provenance);
  if (a.certificate.empty()) return;
  writeCertificateTexts(file, a.certificate, digest);
}

ModelView viewOf(const ModelData& d, const PackedFields& fields) {
  ModelView v;
  v.surface_positions = d.surface_positions;
  v.surface_triangles = d.surface_triangles;
  v.surface_mesh_tag = d.surface_mesh_tag;
  v.position_of_node = d.position_of_node;
  v.contact_node = d.contact_node;
  v.contact_accessible = d.contact_accessible;
  v.contact_triangles = d.contact_triangles.empty() ? d.surface_triangles : d.contact_triangles;
  v.contact_force = d.contact_force;
  v.contact_displacement = d.contact_displacement;
  v.contact_stiffness = d.contact_stiffness;
  v.contact_domain_radius = d.contact_domain_radius;
  v.contact_series_radius = d.contact_series_radius;
  v.levels_Z = d.levels_Z;
  if (d.attributes.parameters == Parameters::kLevel) v.level_functions = fieldCoefficients(d);
  v.modes_X = std::span<const std::int16_t>(fields.X.whole);
  v.modes_X_scale = fields.X.scale;
  v.modes_Y = std::span<const std::int16_t>(fields.Y.whole);
  v.modes_Y_scale = fields.Y.scale;
  v.near_offset = d.near_offset;
  v.near_node = d.near_node;
  v.near_field = std::span<const std::int16_t>(fields.near.whole);
  v.near_scale = fields.near.scale;
  v.green_node = d.green_node;
  v.green_Y = std::span<const std::int16_t>(fields.green_Y.whole);
  v.green_Y_scale = fields.green_Y.scale;
  v.green_offset = d.green_offset;
  v.green_near_node = d.green_near_node;
  v.green_near = std::span<const std::int16_t>(fields.green_near.whole);
  v.green_near_scale = fields.green_near.scale;
  v.edge_offset = d.edge_offset;
  v.edge_node = d.edge_node;
  v.edge_field = std::span<const std::int16_t>(fields.edges.whole);
  v.edge_scale = fields.edges.scale;
  v.mesh_nodes = d.mesh_nodes;
  v.mesh_tetrahedra = d.mesh_tetrahedra;
  v.mesh_midsides = d.mesh_midsides;
  v.mesh_node_tag = d.mesh_node_tag;
  v.mesh_tetrahedron_tag = d.mesh_tetrahedron_tag;
  v.mesh_fixed = d.mesh_fixed;
  v.mesh_surface_node = d.mesh_surface_node;
  v.mesh_element_region = d.mesh_element_region;
  v.region_name = d.region_name;
  v.region_E = d.region_E;
  v.region_nu = d.region_nu;
  v.region_law = d.region_law;
  v.spring_node = d.spring_node;
  v.spring_stiffness = d.spring_stiffness;
  return v;
}

}  // namespace

std::uint64_t storedBytes(const ModelData& data) {
  const PackedFields fields = packFields(data);
  const ModelView view = viewOf(data, fields);
  constexpr std::uint64_t kFile = 20000, kDataset = 512;  // of HDF5's own
  std::uint64_t bytes = kFile + data.attributes.provenance.size();
  forEachDataset(data.attributes, view, [&](const auto&, const auto& values) {
    const std::uint64_t size = values.size() * asStored(values, data.compact, [](const auto& number) {
                                 return std::uint64_t{sizeof number};
                               });
    bytes += (size + kArrayAlignment - 1) / kArrayAlignment * kArrayAlignment + kDataset;
  });
  return bytes;
}

void writeModel(const std::filesystem::path& path, const ModelData& data) {
  checkSizes(data);
  ModelAttributes attributes = data.attributes;
  attributes.force_order = forceOrder(attributes);
  const PackedFields fields = packFields(data);
  writeModel(path, attributes, viewOf(data, fields), data.compact);
}

bool isCompact(const ModelView& view) {
  return view.modes_X.int8() != nullptr;
}

void writeModelTo(const std::filesystem::path& path, const ModelAttributes& attributes, const ModelView& view,
                  bool compact) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors leave as exceptions, not as HDF5's own print-out
  Hdf5Handle file = createFile(path);
  makeGroups(file, attributes, view);
  writeContent(file, attributes, view, compact);
  require(file.closeNow(), path);
}

void writeModel(const std::filesystem::path& path, const ModelAttributes& attributes, const ModelView& view,
                bool compact) {
  program::FileBeside beside(path);
  try {
    writeModelTo(beside.path(), attributes, view, compact);
    sync(beside.path());
    beside.takePlace();
    syncFolder(path);
  } catch (const program::WriteError& error) {
    throw ModelFileError(path.string() + ": cannot be written: " + error.reason());
  } catch (const ModelFileError& error) {
    throw ModelFileError(path.string() + ": " + error.what());
  }
}

}  // namespace palpate::modelfile
