// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "palpate/testing/synthetic_model.h"
#include "tools/examine/fit/estimate.h"
#include "tools/examine/fit/fit_error.h"
#include "tools/examine/query/answer.h"

namespace palpate::fit::test {

/// A round organ that gets stiffer the deeper it is pressed, and a tool on its top.
struct PressedOrgan {
  static MetaModel load() {
    const palpate::testing::TemporaryFile file("pressed.h5");
    palpate::testing::writeSyntheticModel(file.path(), {.subdivisions = 2, .nonlinearity = 0.3});
    return MetaModel::load(file.path());
  }
  MetaModel model{load()};
  query::Anchor anchor{query::anchorNear(model, {0.01, 0.0, 0.05})};
  Press press{model, anchor.s, -model.surface().normal(anchor.s), Measured::kAlong};
  double deepest{press.domainRadius()};  // m

  /// Readings at even depths from first to last, of an organ whose E is `scale` times the model's; contact begins at offset.
  [[nodiscard]] MeasuredCurve curve(int count, double first, double last, double scale,
                                    double offset = 0.0) const {
    MeasuredCurve curve{"curve.csv", {}, false};
    for (int i = 0; i < count; ++i) {
      const double depth = count == 1 ? last : first + (last - first) * i / (count - 1);
      curve.points.push_back({depth, scale * press.at(depth - offset).force});
    }
    return curve;
  }
};

/// The message of the FitError that `work` throws; empty if it throws none.
inline std::string errorOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const FitError& error) {
    return error.what();
  }
  return {};
}

}  // namespace palpate::fit::test
