// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/write_vtk.h"

#include <algorithm>
#include <limits>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "tools/program/write_file.h"

namespace palpate::mesh {
namespace {

constexpr int kLinearTetrahedron = 10, kQuadraticTetrahedron = 24;  // VTK's cell types

void writeCells(std::ostream& out, const TetMesh& mesh) {
  const std::size_t count = mesh.tetrahedra.size(), width = mesh.isQuadratic() ? 10 : 4;
  out << "CELLS " << count << ' ' << count * (width + 1) << '\n';
  for (std::size_t t = 0; t < count; ++t) {
    out << width;
    for (const auto node : mesh.tetrahedra[t]) out << ' ' << node;
    if (mesh.isQuadratic())
      for (const auto node : mesh.midsides[t]) out << ' ' << node;
    out << '\n';
  }
  out << "CELL_TYPES " << count << '\n';
  for (std::size_t t = 0; t < count; ++t)
    out << (mesh.isQuadratic() ? kQuadraticTetrahedron : kLinearTetrahedron) << '\n';
}

void writeMarks(std::ostream& out, const char* head, std::size_t count,
                const std::map<std::string, std::vector<std::int32_t>>& sets) {
  if (sets.empty()) return;
  out << head << ' ' << count << '\n';
  for (const auto& [name, members] : sets) {
    std::string word = name;
    std::replace_if(
        word.begin(), word.end(), [](unsigned char c) { return c <= ' '; }, '_');
    std::vector<char> is_in(count, '0');
    for (const auto i : members) is_in[static_cast<std::size_t>(i)] = '1';
    out << "SCALARS " << word << " int 1\nLOOKUP_TABLE default\n";
    for (const char mark : is_in) out << mark << '\n';
  }
}

}  // namespace

void writeVtk(const std::filesystem::path& path, const TetMesh& mesh) {
  program::writeFile(path, [&](std::ostream& out) {
    out.precision(std::numeric_limits<double>::max_digits10);
    out << "# vtk DataFile Version 3.0\norgan, m\nASCII\nDATASET UNSTRUCTURED_GRID\n";
    out << "POINTS " << mesh.nodes.size() << " double\n";
    for (const auto& x : mesh.nodes) out << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
    writeCells(out, mesh);
    writeMarks(out, "POINT_DATA", mesh.nodes.size(), mesh.groups);
    writeMarks(out, "CELL_DATA", mesh.tetrahedra.size(), mesh.regions);
  });
}

}  // namespace palpate::mesh
