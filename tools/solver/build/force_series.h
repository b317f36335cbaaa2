// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "tools/mesh/tet_mesh.h"
#include "tools/modelfile/model_data.h"
#include "tools/solver/build/build_options.h"
#include "tools/solver/build/case_file.h"

namespace palpate::solver {

/// Number of modes that a series is compressed to, and sweeps of the fit.
struct FitSize {
  int modes{167};  ///< n, >= 1
  int sweeps{6};   ///< >= 1
};

/// Method series-force: u(X; s, f) = sum_k X_k(X) sum_alpha (f / f_ref)^alpha Y_k,alpha(s), compressed to
/// several sizes. The series itself is solved once.
///                                                                       docs/design.md, Reproduction, Series
/// @param report  of the last size  @return one model for each size
/// @throw CaseError, std::runtime_error
[[nodiscard]] std::vector<modelfile::ModelData> buildForceSeries(const Case& c, const mesh::TetMesh& mesh,
                                                                 const BuildOptions& options,
                                                                 std::span<const FitSize> sizes,
                                                                 BuildReport& report);

}  // namespace palpate::solver
