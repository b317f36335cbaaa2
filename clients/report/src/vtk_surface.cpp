// SPDX-License-Identifier: Apache-2.0
#include "palpate/report/vtk_surface.h"

#include <functional>
#include <sstream>

#include "palpate/client/error.h"
#include "palpate/program/write_file.h"

namespace palpate::report {
namespace {

using client::Surface;

// The blocks that both formats share, each one entry a line.
struct Blocks {
  const Surface& surface;
  const std::vector<float>& u;

  void points(std::ostream& out) const {
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
      const client::Point& X = surface.positions[i];
      for (std::size_t j = 0; j < 3; ++j)
        out << X[j] + static_cast<double>(u[3 * i + j]) << (j < 2 ? ' ' : '\n');
    }
  }
  void displacement(std::ostream& out) const {
    for (std::size_t i = 0; i < u.size(); ++i) out << u[i] << (i % 3 < 2 ? ' ' : '\n');
  }
  void accessible(std::ostream& out) const {
    for (const auto value : surface.accessible) out << static_cast<int>(value) << '\n';
  }
  void meshTags(std::ostream& out) const {
    for (const auto tag : surface.mesh_tags) out << tag << '\n';
  }
  void triangles(std::ostream& out, const char* prefix) const {
    for (const auto& t : surface.triangles) out << prefix << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  }
};

std::string legacy(const Blocks& blocks) {
  const std::size_t nodes = blocks.surface.positions.size();
  const std::size_t triangles = blocks.surface.triangles.size();
  std::ostringstream out;
  out.precision(9);
  out << "# vtk DataFile Version 3.0\npalpate surface of model " << blocks.surface.model_id
      << ", m\nASCII\nDATASET POLYDATA\nPOINTS " << nodes << " double\n";
  blocks.points(out);
  out << "POLYGONS " << triangles << ' ' << 4 * triangles << '\n';
  blocks.triangles(out, "3 ");
  out << "POINT_DATA " << nodes << "\nVECTORS displacement float\n";
  blocks.displacement(out);
  out << "SCALARS accessible int 1\nLOOKUP_TABLE default\n";
  blocks.accessible(out);
  out << "SCALARS mesh_tag long 1\nLOOKUP_TABLE default\n";
  blocks.meshTags(out);
  return out.str();
}

void array(std::ostream& out, const char* attributes, const std::function<void()>& content) {
  out << "<DataArray " << attributes << " format=\"ascii\">\n";
  content();
  out << "</DataArray>\n";
}

std::string xml(const Blocks& blocks) {
  const std::size_t triangles = blocks.surface.triangles.size();
  std::ostringstream out;
  out.precision(9);
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" "
         "version=\"0.1\"><UnstructuredGrid>\n<Piece NumberOfPoints=\""
      << blocks.surface.positions.size() << "\" NumberOfCells=\"" << triangles << "\">\n<Points>\n";
  array(out, "type=\"Float64\" NumberOfComponents=\"3\"", [&] { blocks.points(out); });
  out << "</Points>\n<Cells>\n";
  array(out, "type=\"Int64\" Name=\"connectivity\"", [&] { blocks.triangles(out, ""); });
  array(out, "type=\"Int64\" Name=\"offsets\"", [&] {
    for (std::size_t i = 1; i <= triangles; ++i) out << 3 * i << '\n';
  });
  array(out, "type=\"UInt8\" Name=\"types\"", [&] {
    for (std::size_t i = 0; i < triangles; ++i) out << "5\n";
  });
  out << "</Cells>\n<PointData Vectors=\"displacement\">\n";
  array(out, "type=\"Float32\" Name=\"displacement\" NumberOfComponents=\"3\"",
        [&] { blocks.displacement(out); });
  array(out, "type=\"UInt8\" Name=\"accessible\"", [&] { blocks.accessible(out); });
  array(out, "type=\"Int64\" Name=\"mesh_tag\"", [&] { blocks.meshTags(out); });
  out << "</PointData>\n</Piece>\n</UnstructuredGrid></VTKFile>\n";
  return out.str();
}

}  // namespace

void checkSurfacePath(const std::filesystem::path& path) {
  if (path.extension() != ".vtu" && path.extension() != ".vtk")
    throw client::ClientError("cannot write " + path.string() +
                              ": expected a name that ends in .vtu or .vtk");
}

void writeSurface(const std::filesystem::path& path, const Surface& surface,
                  const std::vector<float>& displacement) {
  checkSurfacePath(path);
  if (displacement.size() != 3 * surface.positions.size())
    throw client::ClientError("displacement has " + std::to_string(displacement.size()) +
                              " entries, expected " + std::to_string(3 * surface.positions.size()));
  const Blocks blocks{surface, displacement};
  program::writeFile(path, path.extension() == ".vtu" ? xml(blocks) : legacy(blocks));
}

}  // namespace palpate::report
