// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

#include "tools/mesh/tet_mesh.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solver {

/// What a solve takes, from a measured probe: within 30 % where the machine does as much then as it does now, edges are needed, and
/// near fields of 4.5 patch radii are enough (up to 3700 surface nodes; docs/scale.md).
struct Estimate {
  double factor{0}, mesh_error{0}, orders{0}, series{0}, fit{0}, edges{0}, write{0};  ///< s, wall
  double probe{0};     ///< s: what the probe itself took
  double memory{0};    ///< bytes, largest resident
  double resident{0};  ///< bytes, of these there already
  double scratch{0};   ///< bytes, of this rank
  double file{0};      ///< bytes
  int modes{0};        ///< as given, or about as many as the field's error wants

  [[nodiscard]] double seconds() const { return factor + mesh_error + orders + series + fit + edges + write; }
};

/// What a series-displacement solve of this case takes. Chooses the orders as the solve does, solves a few positions and loads
/// on all workers, and counts. @param[out] report  of what was chosen
/// @throw as buildDisplacementSeries() does
[[nodiscard]] Estimate estimateDisplacementSeries(const Case& c, const mesh::TetMesh& organ,
                                                  const BuildOptions& options, BuildReport& report);

/// @param estimate  of memory and file too high by up to 30 %: what may still fit is not refused
/// @param output  folder of the file, empty: none  @throw CaseError  memory, scratch or file are more than there is, with what
/// would make them fit
void requireRoom(const Estimate& estimate, const Case& c, const BuildOptions& options,
                 const std::filesystem::path& output);

}  // namespace palpate::solver
