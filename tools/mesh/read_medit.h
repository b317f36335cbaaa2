// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/byte_reader.h"
#include "tools/mesh/raw_mesh.h"

namespace palpate::mesh {

/// Reads a Medit .mesh file, for readMesh(). @throw MeshError
RawMesh readMedit(ByteReader in);

}  // namespace palpate::mesh
