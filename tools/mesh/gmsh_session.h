// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "tools/mesh/tet_mesh.h"

namespace palpate::mesh {

/// Owns the one Gmsh of the process: silent, without the user's configuration files.
/// Gmsh is global state: one session at a time, one thread.
class GmshSession {
 public:
  GmshSession();
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

  /// Runs `work`, which calls Gmsh, and turns every exception of Gmsh into a MeshError `what: reason`.
  void run(const std::string& what, const std::function<void()>& work) const;

  /// The tetrahedra of the current Gmsh model, nodes in order of Gmsh's numbers, renumbered from 1. Named
  /// physical volumes are regions; no groups.
  [[nodiscard]] TetMesh tetrahedra() const;
};

}  // namespace palpate::mesh
