// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/mesh/byte_reader.h"
#include "tools/mesh/triangle_surface.h"

namespace palpate::mesh {

/// Reads an .stl file, for readSurface(). @throw MeshError
TriangleSurface readStl(ByteReader in);

}  // namespace palpate::mesh
