// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/read_surface.h"

#include <algorithm>
#include <cctype>

#include "tools/mesh/mesh_error.h"
#include "tools/mesh/read_obj.h"
#include "tools/mesh/read_stl.h"

namespace palpate::mesh {
namespace {

std::string lowerExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

bool isSurfaceFile(const std::filesystem::path& path) {
  const std::string extension = lowerExtension(path);
  return extension == ".stl" || extension == ".obj";
}

TriangleSurface readSurface(const std::filesystem::path& path) {
  const std::string extension = lowerExtension(path);
  if (extension != ".stl" && extension != ".obj") {
    throw MeshError(path.string() + ": the extension '" + extension + "' is not one of .stl, .obj");
  }
  TriangleSurface surface = extension == ".stl" ? readStl(ByteReader(path)) : readObj(ByteReader(path));
  if (surface.triangles.empty()) throw MeshError(path.string() + ": the file holds no triangles");
  return surface;
}

}  // namespace palpate::mesh
