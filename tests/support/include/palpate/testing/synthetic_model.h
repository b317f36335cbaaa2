// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "core/base/types.h"
#include "palpate/testing/files.h"
#include "tools/modelfile/model_data.h"

namespace palpate::testing {

/// A round organ with invented, smooth coefficients: known in closed form, no solver needed.
struct SyntheticOptions {
  int subdivisions{3};                   ///< of the icosahedron: 10 * 4^n + 2 surface nodes
  double radius{0.05};                   ///< m
  int order{3};                          ///< p, of the fields
  int force_order{0};                    ///< of the force, up to 8; 0: as the fields
  int modes{6};                          ///< n
  double near_radius{0.02};              ///< m
  double reference_displacement{0.005};  ///< m
  double domain_radius{0.008};           ///< d_max, m
  double series_radius{0.0};             ///< r_max, m; where less than d_max: d_max
  double stiffness{300.0};               ///< N/m, tangential; the normal one is 1.5 times as large
  double nonlinearity{0.1};              ///< size of the higher terms at d_ref
  double contrast{0.0};      ///< stiffness from place to place: 1 - contrast to 1 + contrast times as large
  double fixed_below{-0.7};  ///< z / radius below which nodes are fixed and have no contact position
  double nodule_above{
      2.0};  ///< z / radius above which tetrahedra are of a region "nodule", 10 times as stiff
  double helper_below{-0.55};  ///< z / radius below which contact positions are helpers, not accessible
  Parameters parameters{Parameters::kDisplacement};  ///< the other kinds have no near field
  double reference_force{0.8};                       ///< f_ref of a "force" model, N
  double domain_force{1.2};                          ///< f_max of a "force" model, N
  double load{1.5};                                  ///< of a "level" model at t = 1, N, along (0, 0.6, -0.8)
  int level_functions{3};                            ///< Z_q(t) = t^(q + 1) at the steps
  int level_steps{10};                               ///< L
  double domain_level{0.85};                         ///< t_max of a "level" model
};

/// All datasets. Surface node i is volume node i; the last volume node is the centre. Outward normal at X is
/// X / |X|.
[[nodiscard]] modelfile::ModelData syntheticModel(const SyntheticOptions& options = {});

/// /contact/stiffness: K(X), N/m, at the places of the smooth interpolant, and its gradient by differences.
void fillStiffness(modelfile::ModelData& data, const std::function<Mat3(const Vec3&)>& K);

/// Writes them with writeModel().
void writeSyntheticModel(const std::filesystem::path& path, const SyntheticOptions& options = {});

/// The energy W_s(d) at surface point X, J, whose gradient the model's force is at a node that lies at X; of a
/// "force" model the complementary energy W*_s(f), whose gradient the displacement is. @param d  m, or f, N
[[nodiscard]] double syntheticEnergy(const SyntheticOptions& options, const Vec3& X, const Vec3& d);

}  // namespace palpate::testing
