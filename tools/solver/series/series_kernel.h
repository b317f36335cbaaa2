// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "tools/solver/base/cauchy_product.h"
#include "tools/solver/base/lanes.h"
#include "tools/solver/fem/fe_model.h"
#include "tools/solver/series/node_order.h"
#include "tools/solver/series/point_kernel.h"

namespace palpate::solver {

/// What the kernels read: the points of elements of four or of ten nodes, and fields as in PointInput.
struct KernelInput {
  const FeModel::Points* points;
  int coefficients;     ///< stride of U and V
  const Lanes* U;       ///< U_alpha
  const FloatLanes* V;  ///< U_alpha length^|alpha|, for energies and bounds
  double length;        ///< of an element's size, m (driven by force: N)
};

/// r[node][k - first][3] += r_alpha for the coefficients first <= k < last of one degree:
///   r_alpha = int P'_alpha : grad delta,  P'_alpha the part of P_alpha that lower degrees make
///                                                                                     docs/design.md, Series
/// The coefficients below `first` must be in U.
void assembleDegree(const KernelInput& input, const CauchyProduct& product, int first, int last, Lanes* r);

/// W[k] += length^|gamma| W_gamma, J, for the coefficients of `rows`, of the first `fields` coefficients that V holds:
/// terms in float32, their sum over points in double.
/// @param factors  pairs for what the law carries, up to the degree that W needs  @param count  of rows
void energyCoefficients(const KernelInput& input, int fields, const CauchyProduct& factors,
                        const CauchyRows& rows, int count, Lanes* W);

/// A solution v of one degree, and what becomes of it.
struct SolvedRows {
  const Lanes* v;  ///< [row][k - first]
  int first, last;
  const Lanes* mix;  ///< [k - first][3]
  double unit;       ///< length^|alpha|
};

/// U_k, first <= k < last, and V_k = unit U_k, with one pass over the rows. The first degree is
/// U_k = sum_i v_i mix_ki, the others are U_k = -v_k + sum_i U_{e_i} mix_ki.
/// @param[out] U, V  [place][coefficients][3]
void fieldsFromRows(std::span<const NodeRow> rows, const SolvedRows& solved, int coefficients, Lanes* U,
                    FloatLanes* V);

/// u = sum_k x^alpha_k U_k at the first nodes, [node][3]. @param monomials  [k] lanes: x^alpha of each lane's sample
void sumFields(const KernelInput& input, int nodes, const Lanes* monomials, Lanes* u);

/// least = min(least, det F) over the points, lane by lane.
/// @param summed  fields of one coefficient, such as sumFields makes
void leastDetF(const KernelInput& summed, Lanes* least);

/// bounds[n]: a bound of |H|_F in point n within the ball |d| <= radius:
///   sum_degree radius^degree (sum_(|alpha| = degree) |H_alpha|_F^2)^1/2, since sum x^2alpha <= |x|^2degree
/// @param powers  [degree - 1] lanes: (radius / length)^degree
void gradientBounds(const KernelInput& input, const FloatLanes* powers, FloatLanes* bounds);

}  // namespace palpate::solver
