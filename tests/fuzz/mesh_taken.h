// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "targets.h"
#include "tools/mesh/byte_reader.h"
#include "tools/mesh/raw_mesh.h"
#include "tools/mesh/triangle_surface.h"

namespace palpate::fuzz {

/// Reads a mesh, and looks whether all that it refers to is there. @return whether it was taken
bool taken(Bytes input, mesh::RawMesh (*read)(mesh::ByteReader));
bool taken(Bytes input, mesh::TriangleSurface (*read)(mesh::ByteReader));

}  // namespace palpate::fuzz
