// SPDX-License-Identifier: Apache-2.0
#include "core/model/patch_stiffness.h"

#include <stdexcept>
#include <string>

#include "core/base/index.h"
#include "core/data/datasets.h"

namespace palpate {

namespace {

Mat3 symmetric(const Vec6& entries) noexcept PALPATE_NONBLOCKING {
  Mat3 K;
  K << entries[0], entries[1], entries[2], entries[1], entries[3], entries[4], entries[2], entries[4],
      entries[5];
  return K;
}

}  // namespace

PatchStiffness::PatchStiffness(const ModelView& view, const ModelAttributes& attributes,
                               const SmoothPlaces& places)
    : stiffness_(view.contact_stiffness), cubic_of_(view.contactTriangles(), -1) {
  if (attributes.parameters != Parameters::kDisplacement) return;
  const std::size_t found = stiffness_.size() / kStiffnessNumbers;
  if (found != places.size())
    throw std::invalid_argument(
        dataset::kContactStiffness.name() + " has " + std::to_string(found) + " places, expected " +
        std::to_string(places.size()) +
        ": the contact positions and the edges between them in triangles of three positions");
  for (std::size_t t = 0; t < cubic_of_.size(); ++t) {
    const std::array<std::int32_t, 6>& place = places.of(static_cast<std::int32_t>(t));
    if (place[0] < 0) continue;
    std::array<Vec3, 3> X;
    for (std::size_t k = 0; k < 3; ++k)
      X[k] = Eigen::Map<const Vec3>(view.surface_positions.data() +
                                    3 * index(view.contact_triangles[3 * t + k]));
    SmoothCubic<6> cubic;
    for (std::size_t k = 0; k < 3; ++k) cubic.squares[k] = (X[(k + 1) % 3] - X[(k + 2) % 3]).squaredNorm();
    for (std::size_t p = 0; p < place.size(); ++p) {
      const Eigen::Map<const Eigen::Matrix<double, 4, 6>> row(stiffness_.data() +
                                                              kStiffnessNumbers * index(place[p]));
      cubic.point[p][0] = row.row(0);
      for (std::size_t e = 1; e < 3; ++e) cubic.point[p][e] = (X[e] - X[0]).transpose() * row.bottomRows<3>();
    }
    cubic_of_[t] = static_cast<std::int32_t>(cubics_.size());
    cubics_.push_back(cubic);
  }
}

void PatchStiffness::at(const SurfaceMesh& surface, const ContactPoint& s,
                        Value& out) const noexcept PALPATE_NONBLOCKING {
  out = Value{};
  if (s.triangle < 0 || index(s.triangle) >= cubic_of_.size()) return;
  const std::int32_t number = cubic_of_[index(s.triangle)];
  if (number < 0) {
    const PositionMix mix = surface.mix(s);
    for (Mat3& slope : out.slope) slope.setZero();
    for (std::size_t b = 0; b < index(mix.count); ++b) {
      const Eigen::Map<const Eigen::Matrix<double, 4, 6>> row(stiffness_.data() +
                                                              kStiffnessNumbers * index(mix.position[b]));
      out.K += mix.weight[b] * symmetric(row.row(0));
    }
    return;
  }
  SmoothCubic<6>::Jet jet;
  cubics_[index(number)].at(s.barycentric, jet);
  out.K = symmetric(jet.value);
  for (std::size_t k = 0; k < 3; ++k) out.slope[k] = symmetric(jet.slope[k]);
}

}  // namespace palpate
