// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/write_xdmf.h"

#include <sstream>
#include <string>
#include <type_traits>

#include "core/data/datasets.h"
#include "core/model/meta_model.h"
#include "tools/modelfile/model_data.h"
#include "tools/program/write_file.h"
#include "tools/program/xml.h"

namespace palpate::modelfile {

namespace {

/// A reference to a whole dataset of the model file.
template <class T>
std::string dataItem(const std::string& file, const Dataset<T>& dataset, const std::string& shape) {
  return "<DataItem Format=\"HDF\" Dimensions=\"" + shape + "\" NumberType=\"" +
         (std::is_floating_point_v<T> ? "Float" : "Int") + "\" Precision=\"" + std::to_string(sizeof(T)) +
         "\">" + file + ":" + dataset.name() + "</DataItem>";
}

/// Mode k is column k of /modes/X, read as one vector for each surface node: whole numbers, their scale beside them.
std::string mode(const std::string& file, std::size_t k, const ModelView& v) {
  const std::size_t modes = v.modes(), nodes = v.surfaceNodes();
  const std::string rows = std::to_string(3 * nodes);
  std::ostringstream out;
  out << "      <Attribute Name=\"mode " << k << "\" AttributeType=\"Vector\" Center=\"Node\">\n"
      << "        <Information Name=\"scale\" Value=\"" << v.modes_X_scale[k] << "\"/>\n"
      << "        <DataItem ItemType=\"HyperSlab\" Dimensions=\"" << nodes << " 3\">\n"
      << "          <DataItem Format=\"XML\" Dimensions=\"3 2\">"
      << "0 " << k << "  1 1  " << rows << " 1</DataItem>\n"
      << "          " << dataItem(file, dataset::kModesX, rows + " " + std::to_string(modes)) << "\n"
      << "        </DataItem>\n"
      << "      </Attribute>\n";
  return out.str();
}

void writeGrid(std::ostream& out, const std::string& file, const ModelView& v) {
  const std::size_t nodes = v.surfaceNodes(), triangles = v.triangles();
  out << "    <Grid Name=\"rest surface\" GridType=\"Uniform\">\n"
      << "      <Topology TopologyType=\"Triangle\" NumberOfElements=\"" << triangles << "\">\n        "
      << dataItem(file, dataset::kSurfaceTriangles, std::to_string(triangles) + " 3")
      << "\n      </Topology>\n"
      << "      <Geometry GeometryType=\"XYZ\">\n        "
      << dataItem(file, dataset::kSurfacePositions, std::to_string(nodes) + " 3") << "\n      </Geometry>\n"
      << "      <Attribute Name=\"mesh tag\" AttributeType=\"Scalar\" Center=\"Node\">\n        "
      << dataItem(file, dataset::kSurfaceMeshTag, std::to_string(nodes)) << "\n      </Attribute>\n"
      << "      <Attribute Name=\"contact position\" AttributeType=\"Scalar\" Center=\"Node\">\n        "
      << dataItem(file, dataset::kPositionOfNode, std::to_string(nodes)) << "\n      </Attribute>\n";
  for (std::size_t k = 0; k < v.modes(); ++k) out << mode(file, k, v);
  out << "    </Grid>\n";
}

}  // namespace

std::filesystem::path writeXdmf(const std::filesystem::path& model) {
  const MetaModel loaded = MetaModel::load(model);
  std::filesystem::path path = model;
  path.replace_extension(".xdmf");
  if (path == model)
    throw ModelFileError(model.string() + ": a model named .xdmf would be overwritten by its .xdmf");
  try {
    program::writeFile(path, [&](std::ostream& out) {
      out << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n";
      writeGrid(out, program::xmlEscaped(model.filename().string()), loaded.view());
      out << "  </Domain>\n</Xdmf>\n";
    });
  } catch (const program::WriteError&) {
    throw ModelFileError(path.string() + " cannot be written; the model itself is whole");
  }
  return path;
}

}  // namespace palpate::modelfile
