// SPDX-License-Identifier: Apache-2.0
#include "core/model/contact_dimple.h"

#include <array>

#include "core/base/index.h"

namespace palpate {

ContactDimple::ContactDimple(const Parts& parts, const SmoothPlaces& places)
    : linear_(places.size()),
      bend_count_(parts.view.positions() == 0 ? 0
                                              : parts.view.modes_Y_scale.size() / parts.view.positions()) {
  const std::size_t n = parts.view.modes();
  PatchNodes patch = parts.patches.room();
  std::vector<float> y(n);
  for (std::size_t place = 0; place < places.size(); ++place) {
    const ContactPoint& s = places.views(place).front().s;
    parts.patches.at(s, false, patch);
    const NodeMix nodes = parts.surface.nodesAt(s);
    Mat3 per_load = Mat3::Zero();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      std::fill(y.begin(), y.end(), 0.0F);
      parts.linear.addAmplitudes(patch, Vec3::Unit(axis), y);
      for (std::size_t k = 0; k < 3; ++k)
        if (nodes.weight[k] > 0.0)
          per_load.col(axis) +=
              nodes.weight[k] * (parts.modes.at(y, nodes.node[k]) +
                                 parts.linear.nearAt(patch, Vec3::Unit(axis), nodes.node[k]));
    }
    PatchStiffness::Value stiffness;
    parts.stiffness.at(parts.surface, s, stiffness);
    linear_[place] = (per_load * stiffness.K).cast<float>();
  }
  std::vector<double> one(bend_count_, 0.0);
  for (std::size_t m = 0; m < parts.view.positions(); ++m) {
    const std::int32_t node = parts.view.contact_node[m];
    for (std::size_t k = 0; k < bend_count_; ++k) {
      one[k] = 1.0;
      std::fill(y.begin(), y.end(), 0.0F);
      parts.amplitudes.add(static_cast<std::int32_t>(m), one, 1.0, y);
      const Vec3 u = parts.modes.at(y, node) + parts.near.at(static_cast<std::int32_t>(m), one, node);
      for (const double number : u) bends_.push_back(static_cast<float>(number));
      one[k] = 0.0;
    }
  }
}

Vec3 ContactDimple::at(const SmoothPlaces& places, const ContactPoint& s, const PositionMix& mix,
                       const Vec3& d, std::span<const double> phi) const noexcept PALPATE_NONBLOCKING {
  const std::array<std::int32_t, 6>& place = places.of(s.triangle);
  Eigen::Matrix3f linear = Eigen::Matrix3f::Zero();
  if (place[0] < 0) {
    for (std::size_t b = 0; b < index(mix.count); ++b)
      linear += static_cast<float>(mix.weight[b]) * linear_[index(mix.position[b])];
  } else {
    std::array<double, 3> corner{}, middle{};  // hat functions; middles opposite to the corners
    const std::array<double, 3>& l = s.barycentric;
    std::size_t near = 3;
    for (std::size_t k = 0; k < 3; ++k)
      if (l[k] > 0.5) near = k;
    for (std::size_t k = 0; k < 3; ++k) middle[k] = near == 3 ? 1.0 - 2.0 * l[k] : 0.0;
    if (near < 3) {
      corner[near] = 2.0 * l[near] - 1.0;
      middle[(near + 2) % 3] = 2.0 * l[(near + 1) % 3];
      middle[(near + 1) % 3] = 2.0 * l[(near + 2) % 3];
    }
    for (std::size_t k = 0; k < 3; ++k)
      linear += static_cast<float>(corner[k]) * linear_[index(place[k])] +
                static_cast<float>(middle[k]) * linear_[index(place[3 + k])];
  }
  Vec3 u = linear.cast<double>() * d;
  for (std::size_t b = 0; b < index(mix.count); ++b) {
    const float* const bend = bends_.data() + 3 * bend_count_ * index(mix.position[b]);
    for (std::size_t k = 0; k < bend_count_; ++k)
      u += mix.weight[b] * phi[k] * Eigen::Map<const Eigen::Vector3f>(bend + 3 * k).cast<double>();
  }
  return u;
}

}  // namespace palpate
