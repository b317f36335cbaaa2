// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/read_medit.h"

#include <map>
#include <string>

#include "tools/mesh/byte_reader.h"

namespace palpate::mesh {
namespace {

// Comments run from # to the end of the line.
std::string_view wordPastComments(ByteReader& in) {
  while (!in.atEnd() && in.rest().front() == '#') in.line();
  return in.atEnd() ? std::string_view("End") : in.word("a keyword");
}

std::size_t countOf(ByteReader& in, const std::string& keyword, std::size_t bytes_each) {
  const std::string what = "the number of " + keyword;
  const auto count = in.textInteger(what.c_str());
  return in.checkedCount(count, bytes_each, what.c_str());
}

void readVertices(ByteReader& in, RawMesh& mesh) {
  const std::size_t count = countOf(in, "Vertices", 8);
  for (std::size_t i = 0; i < count; ++i) {
    auto& x = mesh.points.emplace_back();
    for (Eigen::Index k = 0; k < 3; ++k) x[k] = in.textReal("a vertex's coordinate");
    const auto tag = static_cast<std::int64_t>(mesh.points.size());
    mesh.point_tags.push_back(tag);
    const auto reference = in.textInteger("a vertex's reference");
    if (reference != 0) mesh.groups[{0, reference}].push_back(tag);
  }
}

struct Element {
  int dimension, nodes;
};

void readElements(ByteReader& in, const std::string& keyword, const Element& kind, RawMesh& mesh) {
  const std::size_t count = countOf(in, keyword, 4);
  const std::string what = "a node or reference of " + keyword;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::int64_t, 4> nodes{};
    for (int k = 0; k < kind.nodes; ++k) nodes[static_cast<std::size_t>(k)] = in.textInteger(what.c_str());
    const auto reference = in.textInteger(what.c_str());
    if (kind.dimension == 3) {
      mesh.tetrahedra.push_back(
          {static_cast<std::int64_t>(mesh.tetrahedra.size()) + 1, {nodes.begin(), nodes.end()}, {}});
    }
    if (reference == 0) continue;
    if (kind.dimension == 3) mesh.tetrahedra.back().groups.push_back(reference);
    auto& group = mesh.groups[{kind.dimension, reference}];
    group.insert(group.end(), nodes.begin(), nodes.begin() + kind.nodes);
  }
}

// Skips sections that are not used (ridges, normals, ...): numbers until the next keyword.
void skipNumbers(ByteReader& in) {
  while (!in.atEnd()) {
    const char c = in.rest().front();
    const bool number = (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
    if (!number && c != '#') return;
    number ? void(in.word("a number")) : void(in.line());
  }
}

void checkHead(ByteReader& in) {
  if (wordPastComments(in) != "MeshVersionFormatted")
    in.fail("not a Medit text mesh: no MeshVersionFormatted");
  in.textInteger("the Medit version");
}

}  // namespace

RawMesh readMedit(ByteReader in) {
  static const std::map<std::string, Element> kKept{
      {"Edges", {1, 2}}, {"Triangles", {2, 3}}, {"Quadrilaterals", {2, 4}}, {"Tetrahedra", {3, 4}}};
  RawMesh mesh;
  checkHead(in);
  for (std::string keyword(wordPastComments(in)); keyword != "End"; keyword = wordPastComments(in)) {
    const auto kept = kKept.find(keyword);
    if (kept != kKept.end()) {
      readElements(in, keyword, kept->second, mesh);
    } else if (keyword == "Vertices") {
      readVertices(in, mesh);
    } else if (keyword == "Dimension") {
      if (in.textInteger("the dimension") != 3) in.fail("the dimension is not 3");
    } else if (keyword == "Hexahedra" || keyword == "Prisms" || keyword == "Pyramids" ||
               keyword == "TetrahedraP2") {
      if (countOf(in, keyword, 4) != 0)
        in.fail("the file holds " + keyword + "; only linear tetrahedra are taken");
    } else if (const char c = keyword.front(); (c < 'A' || c > 'Z') && (c < 'a' || c > 'z')) {
      in.fail("'" + keyword.substr(0, 40) + "' is not a keyword");
    } else {
      skipNumbers(in);
    }
  }
  return mesh;
}

}  // namespace palpate::mesh
