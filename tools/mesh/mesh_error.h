// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace palpate::mesh {

/// A mesh or mesh file that cannot be used. what() is one line that names the file or the entity by the
/// number it has in the mesh file.
class MeshError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace palpate::mesh
