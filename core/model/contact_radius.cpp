// SPDX-License-Identifier: Apache-2.0
#include "core/model/contact_radius.h"

#include <algorithm>

namespace palpate {

double contactRadius(const MetaModel& model) {
  constexpr double kNodal = 1e-3;  // of an edge; docs/model_file.md: 1e-6 edges
  const SurfaceMesh& surface = model.surface();
  double edges = 0.0;
  for (std::int32_t t = 0; t < surface.triangles(); ++t) {
    const std::array<Vec3, 3> corner = surface.corners(t);
    for (std::size_t k = 0; k < 3; ++k) edges += (corner[k] - corner[(k + 1) % 3]).norm();
  }
  const double mean = edges / (3.0 * std::max(surface.triangles(), 1));
  const double a = model.attributes().patch_radius;
  return a < kNodal * mean ? mean : a;
}

}  // namespace palpate
