// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/mesh/tet_mesh.h"
#include "tools/modelfile/model_data.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solver {

/// Builds the model of an organ with the method c.method (table of methods: tools/make/solve/README.md).
/// The memory of the series methods depends on the model and the workers only: the table of all fields is in
/// a scratch file.
/// All ranks get the model; they share the work of the series methods, except for a handheld target.
/// @param mesh  checked  @throw CaseError, std::runtime_error
[[nodiscard]] modelfile::ModelData buildModel(const Case& c, const mesh::TetMesh& mesh,
                                              const BuildOptions& options, BuildReport& report);

/// What rounds: OpenBLAS's version and kind of processor, and the instruction set of our own kernel. Another one may give other
/// bits.
[[nodiscard]] std::string arithmetic();

}  // namespace palpate::solver
