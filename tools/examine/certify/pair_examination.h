// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tools/examine/certify/examination.h"

namespace palpate::certify {

/// Two tools at once, model against full solution with both patches.
struct PairFinding {
  std::array<Touch, 2> touches;
  double distance{0.0};     ///< between the places at rest, straight, m
  bool flagged{false};      ///< one of them is beyond the domain; not solved then
  bool solved{false};       ///< Newton's method converged
  double force_error{0.0};  ///< forceError() of the worse of both
  double field_error{0.0};  ///< largest |u - u_Newton| over the surface nodes / the longer d
  double min_det_f{1.0};
};

/// How far two tools are apart, in patch radii.
inline constexpr double kNearestPair = 1.5, kFarthestPair = 8.0;

/// Draws pairs until twice as many as extent.samples are in the domain and solved, at most 20 times as many draws. Prints
/// progress on standard error. @param touches  what they are drawn with. docs/design.md, Certificate
/// @throw CertifyError, query::QueryError, std::runtime_error
[[nodiscard]] std::vector<PairFinding> examinePairs(const MetaModel& model, const query::Organ& organ,
                                                    TouchSampler& touches, double travel,
                                                    const Extent& extent);

/// The least distance from which on the pairs bound the 95 % quantile of both errors by `error`, with 95 % confidence, m.
/// Of 8, 7, .. 2, 1.5 patch radii, tried from the farthest that has 59 pairs beyond it; the first that fails ends it, so that a
/// wrong one is named in at most 5 % of all certificates (tests in a fixed order: W. Maurer, L. A. Hothorn, W. Lehmacher, 1995).
/// @param solved  pairs, in any order  @param patch_radius  m  @return nothing where none does
[[nodiscard]] std::optional<double> leastDistance(std::span<const PairFinding> solved, double patch_radius,
                                                  double error);

}  // namespace palpate::certify
