// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/multi_index.h"
#include "tools/solver/base/lanes.h"
#include "tools/solver/fem/fe_model.h"

namespace palpate::solver {

/// The unordered pairs {b, c}, b + c = alpha, both of degree 1 to factor_order, that make up each coefficient
/// of a basis.
struct CauchyProduct {
  struct Pair {
    int b;
    int c;
  };
  CauchyProduct(const MonomialBasis& basis, int factor_order);
  std::vector<Pair> pairs;
  std::vector<int> begin;  ///< coefficients + 1, offsets into pairs
};

/// One element of the mesh as the kernels read it.
struct KernelElement {
  std::array<std::int32_t, 4> nodes;
  std::array<std::array<double, 3>, 4> gradients;  ///< dN_a/dX, 1/m
  double volume;                                   ///< m^3
};

/// Input of the kernels. U holds all coefficients of all nodes, [node][k][3] lanes.
struct KernelInput {
  const KernelElement* elements;
  int element_count;
  int coefficients;  ///< stride of U
  const Lanes* U;
  double lambda;  ///< Pa
  double mu;      ///< Pa
};

/// r[node][k - first][3] += r_alpha for the coefficients first <= k < last of one degree:
///   S'_alpha = C : sum H_b^T H_c / 2,  r_alpha = int (S'_alpha + sum H_b S_c) : grad delta   docs/design.md, Series
/// The coefficients below `first` must be in U.
void assembleDegree(const KernelInput& input, const CauchyProduct& product, int first, int last, Lanes* r);

/// W[k - first] += the energy coefficients first <= k < last, J m^-|gamma|, of the fields that U holds:
///   E_beta = sym H_beta + sum H_b^T H_c / 2,  W_gamma = int sum E_beta : C : E_beta' / 2,  beta + beta' =
///   gamma
/// @param strain  pairs for E_beta, beta up to the degree that W needs  @param energy  pairs for W_gamma
void energyCoefficients(const KernelInput& input, const CauchyProduct& strain, const CauchyProduct& energy,
                        int first, int last, Lanes* W);

/// det F of one element: F = I + sum x^alpha H_alpha.
/// @param monomials  [k] lanes: x^alpha of each lane's sample  @param[out] det  det F, one per lane
void detF(const KernelInput& input, int element, const Lanes* monomials, Lanes* det);

/// sum_k radius^|alpha_k| |H_alpha_k|_F of one element: a bound of |H|_F in the ball |d| <= radius.
/// @param powers  [k] lanes: radius^|alpha_k|
void gradientBounds(const KernelInput& input, const Lanes* powers, Lanes* bounds);

}  // namespace palpate::solver
