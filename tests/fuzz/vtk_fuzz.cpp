// SPDX-License-Identifier: Apache-2.0
#include "mesh_taken.h"
#include "tools/mesh/read_vtk.h"

bool palpate::fuzz::vtk(Bytes input) {
  return taken(input, mesh::readVtk);
}
