// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/solver/base/cauchy_product.h"
#include "tools/solver/base/lanes.h"
#include "tools/solver/fem/fe_model.h"
#include "tools/solver/series/point_kernel.h"

namespace palpate::solver {

using KernelInput = PointInput<FeModel::kNodes>;

/// r[node][k - first][3] += r_alpha for the coefficients first <= k < last of one degree:
///   r_alpha = int P'_alpha : grad delta,  P'_alpha the part of P_alpha that lower degrees make
///                                                                                     docs/design.md, Series
/// The coefficients below `first` must be in U.
void assembleDegree(const KernelInput& input, const CauchyProduct& product, int first, int last, Lanes* r);

/// W[k - first] += the energy coefficients first <= k < last, J m^-|gamma|, of the fields that U holds.
/// @param strain  pairs for what the law carries, up to the degree that W needs  @param energy  pairs for W_gamma
void energyCoefficients(const KernelInput& input, const CauchyProduct& strain, const CauchyProduct& energy,
                        int first, int last, Lanes* W);

/// det F in one integration point: F = I + sum x^alpha H_alpha.
/// @param monomials  [k] lanes: x^alpha of each lane's sample  @param[out] det  det F, one per lane
void detF(const KernelInput& input, int point, const Lanes* monomials, Lanes* det);

/// sum_k radius^|alpha_k| |H_alpha_k|_F in each integration point: a bound of |H|_F in the ball |d| <= radius.
/// @param powers  [k] lanes: radius^|alpha_k|
void gradientBounds(const KernelInput& input, const Lanes* powers, Lanes* bounds);

}  // namespace palpate::solver
