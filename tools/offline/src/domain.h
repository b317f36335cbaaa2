// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "palpate/offline/series.h"
#include "series_kernel.h"

namespace palpate::offline {

/// The unit directions in which a domain is sampled: faces, edges and corners of a cube, 26.
[[nodiscard]] const std::vector<Vec3>& sampledDirections();

/// Largest |d| up to which, in every sampled direction, the terms of the last degree stay small against the
/// force and df/dd is positive definite. @param force  f_alpha  @return m, at most criteria.cap DESIGN 2.2
[[nodiscard]] double forceRadius(const MonomialBasis& basis, std::span<const Vec3> force,
                                 const DomainCriteria& criteria);

/// Shrinks each lane's radius until det F >= criteria.min_det_f in every element and sampled direction.
void limitByDetF(const MonomialBasis& basis, const KernelInput& input, const DomainCriteria& criteria,
                 std::span<double> radii);

}  // namespace palpate::offline
