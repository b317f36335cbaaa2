// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/examine/fit/measured_curve.h"
#include "tools/examine/fit/press.h"

namespace palpate::fit {

/// What the model's own force is taken to be off at most, at every point: share |f|, but at least share floor.
struct ModelError {
  double share{0.0};
  double floor{0.0};  ///< N, of the model as it is
};

/// How a curve is fitted.
struct FitOptions {
  bool find_offset{true};   ///< false: contact begins at depth 0
  double confidence{0.99};  ///< of the intervals, in (0, 1)
  ModelError model{};
};

/// A number that was found, in its interval value +- (scatter + model).
struct Found {
  double value{0.0};
  double standard_error{0.0};  ///< from the scatter of the curve
  double scatter{0.0};         ///< its quantile of Student's t times that
  double model{0.0};  ///< the most that errors within ModelError add; no confidence covers larger ones

  [[nodiscard]] double halfWidth() const noexcept { return scatter + model; }
};

/// The fit of one curve.
struct Estimate {
  Found scale;                   ///< E / the model's E
  Found offset;                  ///< depth at which contact begins, m; exactly 0 where it was not asked for
  std::vector<double> expected;  ///< scale f(depth - offset) of each point, N
  std::vector<double> residual;  ///< measured less expected of each point, N
  std::size_t in_contact{0};     ///< points with depth > offset: those that the intervals are made of
  std::size_t beyond{0};         ///< of these beyond d_max
};

/// Least squares of F_i = scale f(x_i - offset) + noise, each point weighed by its error.         docs/design.md, Fit
/// Noise is independent from point to point; its size may differ. Points before contact count with f = 0, but give no degree
/// of freedom. The standard error is the larger one of the usual one, which takes noise to be alike, and HC3
/// (J. G. MacKinnon, H. White, J. Econometrics 29 (1985) 305-325), which does not.
/// @throw FitError naming the curve: too few points in contact or in the polynomials' range, a force that does not rise, or no convergence
[[nodiscard]] Estimate estimate(const MeasuredCurve& curve, const Press& press, const FitOptions& options);

}  // namespace palpate::fit
