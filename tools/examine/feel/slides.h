// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/model/meta_model.h"
#include "tools/examine/feel/surface_path.h"

namespace palpate::feel {

struct SlideOptions {
  int paths{100};
  double speed{0.05};   ///< of the tip's centre, m/s
  double depth{0.002};  ///< of the tip below the contact surface, along the interpolated normal, m
  double length{0.05};  ///< of the tip's way, m
  double friction{0.0};
  double coupling_stiffness{0.0};  ///< N/m; 0: none
  unsigned seed{1};
};

/// Measures of one slide.
struct SlideResult {
  double median_step{0.0};  ///< of the force per tick, N
  double largest_step{0.0};
  double largest_ratio{0.0};  ///< largest step / (3 median + 1 % of the force); above 1: a click
  /// largest_ratio after the first 3 mm, in which friction builds up or turns into the direction of the slide
  double largest_ratio_later{0.0};
  /// Largest step at a tenth of the speed, N; 0 without a click. A steep slope of the force gives a tenth of
  /// largest_step, a jump all of it.
  double largest_slow_step{0.0};
  double largest_lag{0.0};  ///< largest |F - F_q| / (|F_q - F_q of the tick before| + 0.1 % of F)
  double mean_force{0.0};   ///< N
  std::size_t worst{0};     ///< tick of largest_ratio
  int releases{0};          ///< ticks without contact after the first one with it
  int ticks{0};
};

/// One slide through step(), without limiter and ramps. The quasi-static answer F_q is the force of the same
/// contact after the tip has stayed at its place for 20 more ticks.
[[nodiscard]] SlideResult slide(const MetaModel& model, const std::vector<PathPoint>& path,
                                const SlideOptions& options);

/// Random smooth slides over the accessible part.
[[nodiscard]] std::vector<SlideResult> slides(const MetaModel& model, const SlideOptions& options);

}  // namespace palpate::feel
