// SPDX-License-Identifier: Apache-2.0
#include "core/model/linear_field.h"

#include <array>

#include "core/base/index.h"

namespace palpate {

namespace {

constexpr std::size_t kLoads = 3;

using Loads = std::array<double, kLoads>;

/// What a patch's node carries, by direction.
Loads share(const PatchNodes& patch, std::size_t i, const Vec3& f) noexcept PALPATE_NONBLOCKING {
  const Vec3 load = patch.weight[i] * f;
  return {load.x(), load.y(), load.z()};
}

}  // namespace

LinearField::LinearField(const ModelView& view)
    : source_of_(view.surfaceNodes(), -1),
      amplitudes_(view.green_Y, view.green_Y_scale, kLoads, view.modes()),
      near_(
          NearField::Arrays{view.green_offset, view.green_near_node, view.green_near, view.green_near_scale},
          kLoads) {
  for (std::size_t g = 0; g < view.green_node.size(); ++g)
    source_of_[index(view.green_node[g])] = static_cast<std::int32_t>(g);
  reach_ = near_.reach(pointsOf(view.surface_positions, view.green_node), view.surface_positions);
}

void LinearField::addAmplitudes(const PatchNodes& patch, const Vec3& f,
                                std::span<float> y) const noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < patch.count; ++i) {
    const std::int32_t source = source_of_[index(patch.node[i])];
    if (source >= 0) amplitudes_.add(source, share(patch, i, f), 1.0, y);
  }
}

void LinearField::addNear(const PatchNodes& patch, const Vec3& f, std::span<float> scratch,
                          std::span<float> u) const noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < patch.count; ++i) {
    const std::int32_t source = source_of_[index(patch.node[i])];
    if (source >= 0) near_.add(source, share(patch, i, f), 1.0, scratch, u);
  }
}

Vec3 LinearField::nearAt(const PatchNodes& patch, const Vec3& f,
                         std::int32_t node) const noexcept PALPATE_NONBLOCKING {
  Vec3 u = Vec3::Zero();
  for (std::size_t i = 0; i < patch.count; ++i) {
    const std::int32_t source = source_of_[index(patch.node[i])];
    if (source >= 0) u += near_.at(source, share(patch, i, f), node);
  }
  return u;
}

std::array<Mat3, 4> LinearField::nearBetween(
    std::int32_t node, std::span<const Eigen::Vector4f> weight) const noexcept PALPATE_NONBLOCKING {
  const std::int32_t source = source_of_[index(node)];
  std::array<Mat3, 4> out;
  if (source >= 0) return near_.weighted(source, weight);
  for (Mat3& part : out) part.setZero();
  return out;
}

}  // namespace palpate
