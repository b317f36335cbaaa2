// SPDX-License-Identifier: Apache-2.0
#include "mesh_taken.h"
#include "tools/mesh/read_obj.h"

bool palpate::fuzz::obj(Bytes input) {
  return taken(input, mesh::readObj);
}
