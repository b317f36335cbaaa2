// SPDX-License-Identifier: Apache-2.0
#include "core/response/largest_stiffness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/index.h"
#include "core/base/symmetric_eigen.h"
#include "core/response/patch_response.h"

namespace palpate {

namespace {

using Directions = std::array<Vec3, 10>;

/// Rest, straight in, 45 degrees off it, and along the surface.
Directions directionsAt(const Vec3& normal) {
  const Vec3 one = normal.unitOrthogonal(), other = normal.cross(one);
  Directions all{Vec3::Zero(), -normal};
  std::size_t next = 2;
  for (const Vec3& aside : {one, other, Vec3(-one), Vec3(-other)}) {
    all[next++] = (aside - normal).normalized();
    all[next++] = aside;
  }
  return all;
}

double largestEigenvalue(const Mat3& K) {
  if (!K.allFinite()) return std::numeric_limits<double>::infinity();
  return symmetricEigen<Mat3>(0.5 * (K + K.transpose())).values.maxCoeff();
}

double largestAt(const MetaModel& model, const ContactPoint& s) {
  const Parameters parameters = model.attributes().parameters;
  const double radius = model.response().domainRadius(model.surface().mix(s));
  const PatchResponse patch(model, s);
  double most = 0.0;
  for (const Vec3& direction : directionsAt(model.surface().normal(s))) {
    Response out;
    const Vec3 load = parameters == Parameters::kLevel ? Vec3(direction.norm(), 0.0, 0.0) : direction;
    const ResponseStatus status = parameters == Parameters::kDisplacement
                                      ? patch.at(radius * direction, out)
                                      : respondToLoad(model, s, radius * load, out);
    if (status != ResponseStatus::kNoAnswer) most = std::max(most, largestEigenvalue(out.stiffness));
  }
  return most;
}

}  // namespace

double largestStiffness(const MetaModel& model) {
  const ModelView& view = model.view();
  std::vector<bool> seen(view.positions(), false);
  double most = 0.0;
  for (std::size_t i = 0; i < view.contact_triangles.size(); ++i) {
    const std::int32_t position = view.position_of_node[index(view.contact_triangles[i])];
    if (position < 0 || seen[index(position)] || view.contact_accessible[index(position)] == 0) continue;
    seen[index(position)] = true;
    ContactPoint s{static_cast<std::int32_t>(i / 3), {}};
    s.barycentric[i % 3] = 1.0;
    most = std::max(most, largestAt(model, s));
  }
  return most;
}

}  // namespace palpate
