// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/contact_point.h"
#include "core/base/types.h"
#include "core/model/meta_model.h"
#include "core/response/patch_response.h"

namespace palpate::fit {

/// What of the force was measured.
enum class Measured {
  kAlong,  ///< the part along the tool's direction: a cell on its axis
  kSize    ///< the length of the vector: a cell of three axes
};

/// Force and its slope at one depth.
struct ForceAt {
  double force{0.0};   ///< N
  double slope{0.0};   ///< N/m
  bool beyond{false};  ///< depth > d_max: the model flags its answer
};

/// A tool that is pressed into an organ at one place, straight: what the model answers.
///   f(x) = e . f(s, x e), or |f(s, x e)|;  f(x) = 0 at x <= 0                              docs/design.md, Fit
class Press {
 public:
  /// Borrows the model. @param model  driven by displacement  @param direction  unit vector e, into the organ
  /// @throw FitError  the place is not accessible, or the direction leads out of the organ
  Press(const MetaModel& model, const ContactPoint& s, const Vec3& direction, Measured measured);

  /// @param depth  x from contact, m
  [[nodiscard]] ForceAt at(double depth) const;
  [[nodiscard]] double domainRadius() const noexcept { return domain_radius_; }  ///< d_max(s), m
  [[nodiscard]] double seriesRadius() const noexcept { return series_radius_; }  ///< r_max(s), m

 private:
  PatchResponse organ_;
  Vec3 direction_;
  Measured measured_;
  double domain_radius_{0.0}, series_radius_{0.0};
};

}  // namespace palpate::fit
