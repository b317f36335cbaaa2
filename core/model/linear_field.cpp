// SPDX-License-Identifier: Apache-2.0
#include "core/model/linear_field.h"

#include <array>

#include "core/base/index.h"

namespace palpate {

namespace {

constexpr std::size_t kLoads = 3;

using Loads = std::array<double, kLoads>;

/// What a patch's node carries, by direction.
Loads loadOf(const PatchNodes& patch, std::size_t i, const Vec3& f) noexcept PALPATE_NONBLOCKING {
  const Vec3 load = patch.weight[i] * f;
  return {load.x(), load.y(), load.z()};
}

constexpr std::array<std::int32_t, 2> kNone{-1, -1};

}  // namespace

LinearField::LinearField(const ModelView& view)
    : sources_(view.surfaceNodes(), kNone),
      amplitudes_(view.green_Y, view.green_Y_scale, kLoads, view.modes()),
      near_(
          NearField::Arrays{view.green_offset, view.green_near_node, view.green_near, view.green_near_scale},
          kLoads) {
  for (std::size_t g = 0; g < view.green_node.size(); ++g)
    sources_[index(view.green_node[g])][0] = static_cast<std::int32_t>(g);
  for (std::size_t f = 0; view.contactTriangles() < view.triangles() && f < view.contactTriangles(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {  // the middle of the edge across from corner k
      std::array<std::int32_t, 2>& middle = sources_[index(view.surface_triangles[12 * f + 9 + k])];
      const auto end = [&](std::size_t turn) {
        return sources_[index(view.contact_triangles[3 * f + (k + turn) % 3])][0];
      };
      if (middle == kNone && end(1) >= 0 && end(2) >= 0) middle = {end(1), end(2)};
    }
  reach_ = near_.reach(pointsOf(view.surface_positions, view.green_node), view.surface_positions);
}

void LinearField::addAmplitudes(const PatchNodes& patch, const Vec3& f,
                                std::span<float> y) const noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < patch.count; ++i)
    forEachSource(patch.node[i], [&](std::int32_t source, double share) noexcept PALPATE_NONBLOCKING {
      amplitudes_.add(source, loadOf(patch, i, f), share, y);
    });
}

void LinearField::addNear(const PatchNodes& patch, const Vec3& f, std::span<float> scratch,
                          std::span<float> u) const noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < patch.count; ++i)
    forEachSource(patch.node[i], [&](std::int32_t source, double share) noexcept PALPATE_NONBLOCKING {
      near_.add(source, loadOf(patch, i, f), share, scratch, u);
    });
}

Vec3 LinearField::nearAt(const PatchNodes& patch, const Vec3& f,
                         std::int32_t node) const noexcept PALPATE_NONBLOCKING {
  Vec3 u = Vec3::Zero();
  for (std::size_t i = 0; i < patch.count; ++i)
    forEachSource(patch.node[i], [&](std::int32_t source, double share) noexcept PALPATE_NONBLOCKING {
      u += share * near_.at(source, loadOf(patch, i, f), node);
    });
  return u;
}

std::array<Mat3, 4> LinearField::nearBetween(
    std::int32_t node, std::span<const Eigen::Vector4f> weight) const noexcept PALPATE_NONBLOCKING {
  std::array<Mat3, 4> out;
  for (Mat3& part : out) part.setZero();
  forEachSource(node, [&](std::int32_t source, double share) noexcept PALPATE_NONBLOCKING {
    const std::array<Mat3, 4> one = near_.weighted(source, weight);
    for (std::size_t k = 0; k < out.size(); ++k) out[k] += share * one[k];
  });
  return out;
}

}  // namespace palpate
