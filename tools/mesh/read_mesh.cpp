// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/read_mesh.h"

#include <algorithm>
#include <cctype>

#include "tools/mesh/mesh_error.h"
#include "tools/mesh/raw_mesh.h"
#include "tools/mesh/read_medit.h"
#include "tools/mesh/read_msh.h"
#include "tools/mesh/read_vtk.h"

namespace palpate::mesh {

TetMesh readMesh(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".msh") return assemble(path, readMsh(ByteReader(path)));
  if (extension == ".vtk") return assemble(path, readVtk(ByteReader(path)));
  if (extension == ".mesh") return assemble(path, readMedit(ByteReader(path)));
  throw MeshError(path.string() + ": the extension '" + extension + "' is not one of .msh, .vtk, .mesh");
}

}  // namespace palpate::mesh
