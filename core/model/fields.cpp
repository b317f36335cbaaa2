// SPDX-License-Identifier: Apache-2.0
#include "core/model/fields.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "core/base/index.h"
#include "core/base/kernels.h"
#include "core/base/multi_index.h"

namespace palpate {

namespace {

using Weights = std::array<float, MonomialBasis::kMaxCoefficients>;

/// Coefficients up to the last that is not zero: a linear field costs no more.
std::size_t used(std::span<const double> phi) noexcept {
  std::size_t count = phi.size();
  while (count > 0 && phi[count - 1] == 0.0) --count;
  return count;
}

/// Weight of each coefficient of one contact position.
Weights scaled(std::span<const double> phi, double factor) noexcept {
  Weights weight;
  for (std::size_t k = 0; k < phi.size(); ++k) weight[k] = static_cast<float>(factor * phi[k]);
  return weight;
}

}  // namespace

SeparatedField::SeparatedField(const ModelView& view)
    : X_(view.modes_X),
      Y_(view.modes_Y),
      X_scale_(view.modes_X_scale),
      Y_scale_(view.modes_Y_scale),
      modes_(static_cast<int>(view.modes())),
      by_node_(X_.size()) {
  const std::size_t n = view.modes(), numbers = 3 * view.surfaceNodes();
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < numbers; ++i)
      by_node_[i * n + k] = X_scale_[k] * static_cast<float>(X_[k * numbers + i]);
  chooseKernels();
}

void SeparatedField::addAmplitudes(const PositionMix& mix, std::span<const double> phi, double gain,
                                   std::span<float> y) const noexcept PALPATE_NONBLOCKING {
  const std::size_t n = y.size();
  for (std::size_t b = 0; b < index(mix.count); ++b) {
    const Weights weight = scaled(phi, gain * mix.weight[b]);
    const std::size_t first = index(mix.position[b]) * phi.size();
    addRows({Y_.data() + first * n, Y_scale_.data() + first, used(phi), n}, weight.data(), y.data());
  }
}

void SeparatedField::expand(std::span<const float> y, std::span<float> u) const noexcept PALPATE_NONBLOCKING {
  std::fill(u.begin(), u.end(), 0.0F);
  addRows({X_.data(), X_scale_.data(), y.size(), u.size()}, y.data(), u.data());
}

Vec3 SeparatedField::at(std::span<const float> y, int node) const noexcept PALPATE_NONBLOCKING {
  std::array<float, 3> u{};
  dotRows(by_node_.data() + 3 * index(node) * y.size(), y.size(), y.data(), u.size(), y.size(), u.data());
  return {u[0], u[1], u[2]};
}

NearField::NearField(const ModelView& view)
    : offset_(view.near_offset), node_(view.near_node), field_(view.near_field), scale_(view.near_scale) {
  std::int64_t most = 0;
  for (std::size_t m = 0; m + 1 < offset_.size(); ++m) most = std::max(most, offset_[m + 1] - offset_[m]);
  scratch_size_ = static_cast<int>(3 * most) + static_cast<int>(view.surfaceNodes());
}

std::span<const std::int32_t> NearField::nodes(std::int32_t position) const noexcept PALPATE_NONBLOCKING {
  const std::size_t m = index(position), first = index(offset_[m]);
  return node_.subspan(first, index(offset_[m + 1]) - first);
}

NearField::Block NearField::block(std::int32_t position, std::span<const double> phi, double factor,
                                  std::span<float> scratch) const noexcept PALPATE_NONBLOCKING {
  const std::size_t m = index(position);
  const std::size_t first = index(offset_[m]), nodes = index(offset_[m + 1]) - first;
  const std::span<float> u = scratch.first(3 * nodes);
  std::fill(u.begin(), u.end(), 0.0F);
  const Weights weight = scaled(phi, factor);
  const std::int16_t* const field = field_.data() + 3 * phi.size() * first;
  addRows({field, scale_.data() + m * phi.size(), used(phi), 3 * nodes}, weight.data(), u.data());
  return {node_.subspan(first, nodes), u};
}

Vec3 NearField::at(std::int32_t position, std::span<const double> phi,
                   std::int32_t node) const noexcept PALPATE_NONBLOCKING {
  const std::span<const std::int32_t> list = nodes(position);
  const auto place = std::find(list.begin(), list.end(), node) - list.begin();
  Vec3 u = Vec3::Zero();
  if (place == std::ssize(list)) return u;
  const std::size_t m = index(position);
  const std::int16_t* field = field_.data() + 3 * (phi.size() * index(offset_[m]) + index(place));
  for (std::size_t k = 0; k < used(phi); ++k, field += 3 * list.size()) {
    const double weight = phi[k] * double(scale_[m * phi.size() + k]);
    for (Eigen::Index axis = 0; axis < 3; ++axis) u[axis] += weight * field[axis];
  }
  return u;
}

void NearField::add(const PositionMix& mix, std::span<const double> phi, double gain,
                    std::span<float> scratch, std::span<float> u) const noexcept PALPATE_NONBLOCKING {
  for (std::size_t b = 0; b < index(mix.count); ++b) {
    const Block near = block(mix.position[b], phi, gain * mix.weight[b], scratch);
    for (std::size_t i = 0; i < near.nodes.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) u[3 * index(near.nodes[i]) + axis] += near.u[3 * i + axis];
  }
}

}  // namespace palpate
