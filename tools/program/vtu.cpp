// SPDX-License-Identifier: Apache-2.0
#include "tools/program/vtu.h"

#include <array>
#include <charconv>
#include <stdexcept>

#include "tools/program/xml.h"

namespace palpate::program {
namespace {

const char* typeName(float) {
  return "Float32";
}
const char* typeName(double) {
  return "Float64";
}
const char* typeName(std::int64_t) {
  return "Int64";
}
const char* typeName(std::uint8_t) {
  return "UInt8";
}

template <class T>
void appendNumber(std::string& out, T value) {
  std::array<char, 32> text{};
  out.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr);
}

// One row per line.
template <class T>
void appendArray(std::string& out, const std::string& name, const std::vector<T>& values,
                 std::size_t columns) {
  out += std::string("<DataArray type=\"") + typeName(T{}) + "\" Name=\"" + xmlEscaped(name) + "\"";
  if (columns > 1) out += " NumberOfComponents=\"" + std::to_string(columns) + "\"";
  out += " format=\"ascii\">\n";
  for (std::size_t i = 0; i < values.size(); ++i) {
    appendNumber(out, values[i]);
    out += (i + 1) % columns == 0 ? '\n' : ' ';
  }
  out += "</DataArray>\n";
}

std::size_t rows(const std::string& what, std::size_t size) {
  if (size % 3 == 0) return size / 3;
  throw std::invalid_argument(what + " has " + std::to_string(size) + " entries, expected three each");
}

std::size_t sizeOf(const PointData& data) {
  return std::visit([](const auto& values) { return values.size(); }, data.values);
}

std::size_t columnsOf(const PointData& data, std::size_t points) {
  const std::size_t size = sizeOf(data);
  if (size == points) return 1;
  if (size == 3 * points) return 3;
  throw std::invalid_argument(data.name + " has " + std::to_string(size) + " entries, expected " +
                              std::to_string(points) + " or " + std::to_string(3 * points));
}

void appendCells(std::string& out, const PointSurface& surface) {
  constexpr std::uint8_t kTriangle = 5;  // VTK's number of this cell type
  const std::size_t count = surface.triangles.size() / 3;
  std::vector<std::int64_t> ends(count);
  for (std::size_t i = 0; i < count; ++i) ends[i] = static_cast<std::int64_t>(3 * (i + 1));
  appendArray(out, "connectivity", surface.triangles, 3);
  appendArray(out, "offsets", ends, 1);
  appendArray(out, "types", std::vector<std::uint8_t>(count, kTriangle), 1);
}

void appendPointData(std::string& out, const PointSurface& surface, std::size_t points) {
  std::string vectors, arrays;
  for (const PointData& data : surface.data) {
    const std::size_t columns = columnsOf(data, points);
    if (columns == 3 && vectors.empty()) vectors = " Vectors=\"" + xmlEscaped(data.name) + "\"";
    std::visit([&](const auto& values) { appendArray(arrays, data.name, values, columns); }, data.values);
  }
  out += "<PointData" + vectors + ">\n" + arrays + "</PointData>\n";
}

}  // namespace

std::string vtuText(const PointSurface& surface) {
  const std::size_t points = rows("points", surface.points.size());
  const std::size_t triangles = rows("triangles", surface.triangles.size());
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">\n<UnstructuredGrid>\n"
      "<Piece NumberOfPoints=\"" +
      std::to_string(points) + "\" NumberOfCells=\"" + std::to_string(triangles) + "\">\n<Points>\n";
  appendArray(out, "Points", surface.points, 3);
  out += "</Points>\n<Cells>\n";
  appendCells(out, surface);
  out += "</Cells>\n";
  appendPointData(out, surface, points);
  return out + "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace palpate::program
