// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace palpate::solver {

enum class Separation {
  kScalar,    ///< u = sum X_k(x) Y_k(s): one operator, a block power iteration for the energy-norm SVD
  kHadamard,  ///< u_j = sum X_k,j(x) Y_k,j(s), component by component: one factorization a sweep
};

struct LinearPgdOptions {
  Separation separation{Separation::kScalar};
  std::vector<int> components;  ///< of every unknown, Hadamard only; empty: unknown i belongs to i % 3
  int load_terms{0};            ///< m of Eq. (2), >= 0; 0: the load is not truncated
  int max_pairs{250};           ///< n, >= 1
  double tolerance{1e-3};       ///< stop at this dual norm of the residual over that of the loads, [0, 1)
  int max_sweeps{3};            ///< alternating directions for a pair (or block), >= 1
  double pair_tolerance{1e-2};  ///< stop a pair at this change of the normalized pair in a sweep, >= 0
  int update{8};                ///< pairs between updates of all Y for fixed X, >= 0; 0: never
  int block{8};                 ///< pairs iterated at once, >= 1; scalar only, Hadamard iterates one
  int residual_every{8};        ///< pairs between estimates of the residual, >= 1
  int probes{24};               ///< random combinations of positions that estimate the residual, >= 2
  int workers{1};               ///< threads of the solves, >= 1
  unsigned seed{1};
  bool quiet{false};
};

}  // namespace palpate::solver
