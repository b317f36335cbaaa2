// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/model/meta_model.h"
#include "tools/examine/fit/estimate.h"
#include "tools/examine/fit/measured_curve.h"
#include "tools/examine/fit/press.h"
#include "tools/examine/query/answer.h"

namespace palpate::fit {

/// All that came out of one fit; borrows model, curve and press.
struct Findings {
  const MetaModel& model;
  const MeasuredCurve& curve;
  const Press& press;
  query::Anchor anchor;
  Vec3 direction = Vec3::Zero();  ///< unit vector
  Measured measured{Measured::kAlong};
  FitOptions options;
  bool certified{false};  ///< options.model is the certificate's
  Estimate estimate;

  [[nodiscard]] double E() const { return estimate.scale.value * model.attributes().E; }  ///< Pa
  [[nodiscard]] std::array<double, 2> interval() const;        ///< of E, Pa, from 0
  [[nodiscard]] std::array<double, 2> offsetInterval() const;  ///< m
  [[nodiscard]] double largestForce() const;                   ///< of the curve, N
  [[nodiscard]] double rmsResidual() const;                    ///< N
  [[nodiscard]] std::optional<double> rSquared() const;  ///< not weighted; nothing where all forces are alike
  /// Of the points in contact, in the order of depth: how probable so few changes of sign are; see probabilityOfRuns().
  [[nodiscard]] std::optional<double> runsProbability() const;
  /// The residuals follow each other where they should not, and are larger than the model's own error.
  [[nodiscard]] bool isOfAnotherForm() const;
};

}  // namespace palpate::fit
