// SPDX-License-Identifier: Apache-2.0
#include "mesh_taken.h"
#include "tools/mesh/read_msh.h"

bool palpate::fuzz::msh(Bytes input) {
  return taken(input, mesh::readMsh);
}
