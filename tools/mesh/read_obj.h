// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/byte_reader.h"
#include "tools/mesh/triangle_surface.h"

namespace palpate::mesh {

/// Reads an .obj file, for readSurface(). @throw MeshError
TriangleSurface readObj(ByteReader in);

}  // namespace palpate::mesh
