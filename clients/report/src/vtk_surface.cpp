// SPDX-License-Identifier: Apache-2.0
#include "palpate/report/vtk_surface.h"

#include <sstream>

#include "palpate/client/error.h"
#include "tools/program/vtu.h"
#include "tools/program/write_file.h"

namespace palpate::report {
namespace {

using client::Surface;

std::vector<double> displaced(const Surface& surface, const std::vector<float>& u) {
  std::vector<double> points(u.size());
  for (std::size_t i = 0; i < u.size(); ++i)
    points[i] = surface.positions[i / 3][i % 3] + static_cast<double>(u[i]);
  return points;
}

// One row of the range per line.
template <class Range>
void rows(std::ostream& out, const Range& values, std::size_t columns) {
  std::size_t column = 0;
  for (const auto value : values) {
    out << +value << (++column < columns ? ' ' : '\n');
    column %= columns;
  }
}

std::string legacy(const Surface& surface, const std::vector<float>& u) {
  const std::size_t nodes = surface.positions.size();
  const std::size_t triangles = surface.triangles.size();
  std::ostringstream out;
  out.precision(9);
  out << "# vtk DataFile Version 3.0\npalpate surface of model " << surface.model_id
      << ", m\nASCII\nDATASET POLYDATA\nPOINTS " << nodes << " double\n";
  rows(out, displaced(surface, u), 3);
  out << "POLYGONS " << triangles << ' ' << 4 * triangles << '\n';
  for (const auto& t : surface.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  out << "POINT_DATA " << nodes << "\nVECTORS displacement float\n";
  rows(out, u, 3);
  out << "SCALARS accessible int 1\nLOOKUP_TABLE default\n";
  rows(out, surface.accessible, 1);
  out << "SCALARS mesh_tag long 1\nLOOKUP_TABLE default\n";
  rows(out, surface.mesh_tags, 1);
  return out.str();
}

std::string xml(const Surface& surface, const std::vector<float>& u) {
  program::PointSurface file{
      .points = displaced(surface, u),
      .triangles = {},
      .data = {{"displacement", u}, {"accessible", surface.accessible}, {"mesh_tag", surface.mesh_tags}}};
  for (const auto& t : surface.triangles) file.triangles.insert(file.triangles.end(), t.begin(), t.end());
  return program::vtuText(file);
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
  program::writeFile(path,
                     path.extension() == ".vtu" ? xml(surface, displacement) : legacy(surface, displacement));
}

}  // namespace palpate::report
