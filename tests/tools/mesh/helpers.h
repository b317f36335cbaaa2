// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <string>

#include "palpate/testing/files.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/surface_defects.h"
#include "tools/mesh/tet_mesh.h"
#include "tools/mesh/triangle_surface.h"
#include "tools/program/exit_code.h"

namespace palpate::mesh::test {

using palpate::testing::contentOf;
using palpate::testing::TemporaryFolder;

/// The message of the MeshError or UsageError that `work` throws; empty if it throws none.
inline std::string errorOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const MeshError& error) {
    return error.what();
  } catch (const program::UsageError& error) {
    return error.what();
  }
  return {};
}

/// @throw MeshError naming what keeps a surface from bounding solids
inline void checkSurface(const TriangleSurface& surface) {
  if (const auto defects = surfaceDefects(surface); !defects.empty()) throw MeshError(inWords(defects));
}

/// Appends a number byte by byte, in big-endian order if asked.
template <typename T>
void append(std::string& bytes, T value, bool big_endian = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes += raw[big_endian ? sizeof(T) - 1 - i : i];
}

/// One tetrahedron with the numbers 11, 12, 13, 14; its own number is 7.
inline TetMesh oneTetrahedron() {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.node_tags = {11, 12, 13, 14};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.tetrahedron_tags = {7};
  return mesh;
}

/// The unit cube's twelve triangles, outward.
inline TriangleSurface cube() {
  TriangleSurface surface;
  for (int i = 0; i < 8; ++i) {
    surface.vertices.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
    surface.vertex_tags.push_back(i + 1);
  }
  surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (int i = 0; i < 12; ++i) surface.triangle_tags.push_back(i + 1);
  return surface;
}

// A copy of `text` with `from` replaced by `to`; the test is wrong if it is not there.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

}  // namespace palpate::mesh::test

// The names of the wrong entity and the reason must both be in the message.
#define EXPECT_REFUSED(work, ...)                                                              \
  do {                                                                                         \
    const std::string palpate_message = ::palpate::mesh::test::errorOf([&] { (void)(work); }); \
    EXPECT_FALSE(palpate_message.empty()) << "was not refused";                                \
    EXPECT_EQ(palpate_message.find('\n'), std::string::npos) << palpate_message;               \
    for (const char* palpate_part : {__VA_ARGS__}) {                                           \
      EXPECT_NE(palpate_message.find(palpate_part), std::string::npos)                         \
          << palpate_message << " lacks " << palpate_part;                                     \
    }                                                                                          \
  } while (false)
