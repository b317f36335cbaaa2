// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/read_stl.h"

#include <array>
#include <map>
#include <string>

#include "tools/mesh/byte_reader.h"

namespace palpate::mesh {
namespace {

constexpr std::size_t kBinaryHead = 84;   // 80 bytes of text, a count
constexpr std::size_t kBinaryFacet = 50;  // normal, three corners, two bytes of attributes

// Joins corners at the same place into vertices.
class Collector {
 public:
  void add(const std::array<Eigen::Vector3d, 3>& corners) {
    auto& triangle = surface.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      // Adding zero makes -0 the same key as +0.
      const std::array<double, 3> key{corners[k].x() + 0.0, corners[k].y() + 0.0, corners[k].z() + 0.0};
      const auto [at, added] = vertices_.emplace(key, static_cast<std::int32_t>(surface.vertices.size()));
      if (added) {
        surface.vertices.push_back(corners[k]);
        surface.vertex_tags.push_back(static_cast<std::int64_t>(surface.vertices.size()));
      }
      triangle[k] = at->second;
    }
    surface.triangle_tags.push_back(static_cast<std::int64_t>(surface.triangles.size()));
  }

  TriangleSurface surface;

 private:
  std::map<std::array<double, 3>, std::int32_t> vertices_;
};

std::uint32_t littleEndian32(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

// Text files start with `solid`, but so do some binary ones: then the count fits the size.
bool isBinary(std::string_view bytes) {
  if (bytes.size() < kBinaryHead) return !bytes.starts_with("solid");
  const std::size_t facets = littleEndian32(bytes.substr(80));
  return !bytes.starts_with("solid") || bytes.size() == kBinaryHead + kBinaryFacet * facets;
}

TriangleSurface readBinary(ByteReader& in) {
  in.setBinary(true);
  constexpr std::uint16_t kOne = 1;
  in.swapBytes(*reinterpret_cast<const unsigned char*>(&kOne) != 1);
  in.skip(80, "the head of a binary STL");
  const auto count = in.raw<std::uint32_t>("the number of facets");
  if (in.rest().size() != kBinaryFacet * count) {
    in.fail("the number of facets is " + std::to_string(count) + ", but " + std::to_string(in.rest().size()) +
            " bytes follow instead of " + std::to_string(kBinaryFacet * count));
  }
  Collector collector;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::array<Eigen::Vector3d, 3> corners;
    in.skip(12, "a normal");
    for (auto& corner : corners) {
      for (Eigen::Index k = 0; k < 3; ++k) corner[k] = static_cast<double>(in.raw<float>("a corner"));
    }
    in.skip(2, "a facet");
    collector.add(corners);
  }
  return std::move(collector.surface);
}

void expect(ByteReader& in, const char* wanted) {
  const std::string_view found = in.word(wanted);
  if (found != wanted) in.fail(std::string("expected '") + wanted + "'");
}

std::array<Eigen::Vector3d, 3> readFacet(ByteReader& in) {
  std::array<Eigen::Vector3d, 3> corners;
  expect(in, "normal");
  for (int k = 0; k < 3; ++k) in.word("a normal");
  expect(in, "outer");
  expect(in, "loop");
  for (auto& corner : corners) {
    expect(in, "vertex");
    for (Eigen::Index k = 0; k < 3; ++k) corner[k] = in.textReal("a corner");
  }
  expect(in, "endloop");
  expect(in, "endfacet");
  return corners;
}

TriangleSurface readText(ByteReader& in) {
  Collector collector;
  expect(in, "solid");
  in.line();
  for (std::string_view word = in.word("facet or endsolid"); word != "endsolid";
       word = in.word("facet or endsolid")) {
    if (word != "facet") in.fail("expected 'facet' or 'endsolid'");
    collector.add(readFacet(in));
  }
  return std::move(collector.surface);
}

}  // namespace

TriangleSurface readStl(ByteReader in) {
  return isBinary(in.rest()) ? readBinary(in) : readText(in);
}

}  // namespace palpate::mesh
