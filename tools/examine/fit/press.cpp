// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/fit/press.h"

#include "tools/examine/fit/fit_error.h"
#include "tools/program/printed.h"

namespace palpate::fit {

Press::Press(const MetaModel& model, const ContactPoint& s, const Vec3& direction, Measured measured)
    : organ_(model, s), direction_(direction), measured_(measured) {
  Response rest;
  if (!model.surface().accessible(s.triangle) || organ_.at(Vec3::Zero(), rest) == ResponseStatus::kNoAnswer)
    throw FitError("the place is not accessible: the model has no answer there");
  domain_radius_ = rest.domain_radius;
  series_radius_ = rest.series_radius;
  const Vec3 n = model.surface().normal(s);
  if (!(direction.dot(n) < 0.0))
    throw FitError(
        program::printed("the direction %.4g,%.4g,%.4g does not lead into the organ, whose normal is "
                         "%.4g,%.4g,%.4g there",
                         direction.x(), direction.y(), direction.z(), n.x(), n.y(), n.z()));
}

ForceAt Press::at(double depth) const {
  if (!(depth > 0.0)) return {};
  Response answer;
  const bool beyond = organ_.at(depth * direction_, answer) != ResponseStatus::kOk;
  const Vec3 axis = measured_ == Measured::kAlong ? direction_ : answer.force.normalized();
  return {answer.force.dot(axis), axis.dot(answer.stiffness * direction_), beyond};
}

}  // namespace palpate::fit
