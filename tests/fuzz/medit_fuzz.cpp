// SPDX-License-Identifier: Apache-2.0
#include "mesh_taken.h"
#include "tools/mesh/read_medit.h"

bool palpate::fuzz::medit(Bytes input) {
  return taken(input, mesh::readMedit);
}
