// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace palpate::certify {

/// Fewer samples have no such rank.
inline constexpr std::size_t kLeastSamples = 59;
/// What a certificate has unless told otherwise: the fifth largest bounds, so no single touch decides.
inline constexpr std::size_t kSamples = 181;

/// The least rank k, from 1, for which the k-th smallest of n independent samples is at least their distribution's 95 %
/// quantile with 95 % confidence, whatever the distribution: P(B < k) >= 0.95 for a binomial B of n and 0.95.
/// Wilks, Ann. Math. Stat. 12 (1941) 91-96. 59 samples: the 59th. @return nothing below 59 samples
[[nodiscard]] std::optional<std::size_t> rankOfBound(std::size_t samples);

/// Quantiles of an error, and the bound.
struct ErrorStatistics {
  double p50{0.0}, p95{0.0}, max{0.0};
  std::optional<double> bound_95_95;  ///< nothing: too few samples
};

/// @param errors  in any order, not empty
[[nodiscard]] ErrorStatistics statisticsOf(std::span<const double> errors);

}  // namespace palpate::certify
