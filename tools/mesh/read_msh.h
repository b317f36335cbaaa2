// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/byte_reader.h"
#include "tools/mesh/raw_mesh.h"

namespace palpate::mesh {

/// Reads a Gmsh .msh file, for readMesh(). @throw MeshError
RawMesh readMsh(ByteReader in);

}  // namespace palpate::mesh
