// SPDX-License-Identifier: Apache-2.0
#include "mesh_taken.h"
#include "tools/mesh/read_stl.h"

bool palpate::fuzz::stl(Bytes input) {
  return taken(input, mesh::readStl);
}
