// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <vector>

#include "core/base/multi_index.h"
#include "tools/solver/fit/field_table.h"
#include "tools/solver/fit/near_field.h"

namespace palpate::solver {

/// One source of fields, a contact position: C columns of the table.
struct FitSource {
  Vec3 place;          ///< m; neighbours are worked on together
  FitWeights weights;  ///< of the nodes
  double ball_radius;  ///< m (N): the mean is over this ball of d (f)
  double size;         ///< m: displacement at d_ref (f_ref) that errors are relative to; of d, d_ref itself
};

/// Input of the fit. The table holds U_alpha unscaled, rows node-interleaved. Lengths are relative to each other only:
/// the same organ in another size has the same modes.
struct FitProblem {
  const FieldTable& table;
  const MonomialBasis& basis;
  std::span<const double> areas;       ///< Ns, m^2
  std::span<const Vec3> places;        ///< Ns, m
  std::span<const FitSource> sources;  ///< M
  double reference;                    ///< d_ref, m (f_ref, N): polynomials are in d / d_ref
};

struct FitOptions {
  int modes{120};       ///< n, >= 1; with an asked error the number to begin with
  int sweeps{6};        ///< alternating-direction sweeps over all sources
  int reweighted{0};    ///< how many of them, the last, also move the weights to where the errors are large
  int head_start{0};    ///< sweeps before them over a quarter of the sources
  double error{0.0};    ///< asked 95 % quantile of FarField::largest; 0: the modes are as many as given
  int most_modes{400};  ///< with an asked error
  std::filesystem::path
      scratch{};  ///< folder for principal fields, for sources with near fields; empty: sweeps go over all
  int workers{1};
  bool quiet{false};
};

/// u_far(X; s, d) = sum_k X_k(X) sum_alpha (d / d_ref)^alpha Y_k,alpha(s)               docs/design.md, Parts
struct FarField {
  Eigen::MatrixXf X;  ///< 3 Ns x n, node-interleaved; orthonormal in the area-weighted product; by energy
  Eigen::MatrixXf Y;  ///< n x (M C), column position * C + k, m
  std::vector<double> errors;  ///< after each sweep over all sources: RMS of the error over RMS of the field,
                               ///< in the weights of that sweep
  std::vector<float>
      largest;  ///< M: largest error that is seen at a node over abs(d), in 26 directions, abs(d)
                ///< the ball's radius; where the near field is everything there is none
};

}  // namespace palpate::solver
