// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/multi_index.h"
#include "tools/solver/series/series_kernel.h"

namespace palpate::solver {

/// The unit directions in which a domain is sampled: faces, edges and corners of a cube, 26.
[[nodiscard]] const std::vector<Vec3>& sampledDirections();

/// Largest radius, at most `cap`, up to which, in every sampled direction, the answer to degree `kept` is
/// within `tolerance` of the whole and its derivative is positive definite. The part beyond the last degree
/// is estimated.
///                                                                                     docs/design.md, Series
/// @param answer  coefficients of f(d), or of d(f)
[[nodiscard]] double answerRadius(const MonomialBasis& basis, std::span<const Vec3> answer, int kept,
                                  double cap, double tolerance);

/// Largest radius, at most `cap`, up to which, in every sampled direction, what fields of degree p leave out is
/// estimated to stay within `tolerance` of the radius at every node given.
///                                                                                     docs/design.md, Series
/// @param fields  U_alpha, [node][k]  @param answer  driven by displacement: it tells how fast terms fall beyond p
[[nodiscard]] double fieldRadius(const MonomialBasis& basis, std::span<const Vec3> fields,
                                 const MonomialBasis& answer_basis, std::span<const Vec3> answer, double cap,
                                 double tolerance);

/// Shrinks each lane's radius until det F >= min_det_f in every integration point and sampled direction.
void limitByDetF(const MonomialBasis& basis, const KernelInput& input, double min_det_f,
                 std::span<double> radii);

}  // namespace palpate::solver
