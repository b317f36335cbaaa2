// SPDX-License-Identifier: Apache-2.0
#include "core/model/fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/base/index.h"
#include "core/base/kernels.h"
#include "core/base/multi_index.h"
#include "core/model/mode_tiles.h"
#include "core/model/node_by_node.h"

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
      modes_(static_cast<int>(view.modes())),
      packed_(view.modes_packed),
      counts_(countModes(packed_, view.modes())),
      peak_(view.modes(), 0.0F),
      by_node_(nodeByNode(X_, view.modes())) {
  const std::size_t numbers = 3 * view.surfaceNodes();
  for (std::size_t k = 0; k < peak_.size(); ++k) {
    const float* const x = X_.data() + k * numbers;
    for (std::size_t i = 0; i < numbers; i += 3)
      peak_[k] = std::max(peak_[k], std::hypot(x[i], x[i + 1], x[i + 2]));
  }
  chooseKernels();
}

std::size_t SeparatedField::bytes() const noexcept {
  const std::size_t numbers = peak_.empty() ? 0 : X_.size() / peak_.size();
  return sizeof(float) * counts_.f32 * numbers + packed_.X16.size_bytes() + packed_.X8.size_bytes();
}

void SeparatedField::addAmplitudes(const PositionMix& mix, std::span<const double> phi, double gain,
                                   std::span<float> y) const noexcept PALPATE_NONBLOCKING {
  const std::size_t n = y.size();
  for (std::size_t b = 0; b < index(mix.count); ++b) {
    const Weights weight = scaled(phi, gain * mix.weight[b]);
    const float* const Y = Y_.data() + index(mix.position[b]) * phi.size() * n;
    addWeightedRows(Y, n, weight.data(), used(phi), n, y.data());
  }
}

void SeparatedField::expand(std::span<const float> y, float unseen, ModeSelection& use,
                            std::span<float> u) const noexcept PALPATE_NONBLOCKING {
  const bool onto = counts_.f32 > 0 || packed_.empty();
  if (onto) {
    std::fill(u.begin(), u.end(), 0.0F);
    addWeightedRows(X_.data(), u.size(), y.data(), counts_.f32, u.size(), u.data());
  }
  if (packed_.empty()) return;
  use.choose(y, peak_, packed_, unseen);
  const TileWeights weights{use.pairs16().data(), use.weights16(),     use.pairs16().size(),
                            use.unit16(),         use.quads8().data(), use.weights8(),
                            use.quads8().size(),  use.unit8(),         use.start8()};
  sumTiles(packed_, counts_.pairs(), counts_.quads(), weights, onto, u);
  if (!use.finite()) std::fill(u.begin(), u.end(), std::numeric_limits<float>::quiet_NaN());
}

Vec3 SeparatedField::at(std::span<const float> y, int node) const noexcept PALPATE_NONBLOCKING {
  std::array<float, 3> u{};
  dotRows(by_node_.data() + 3 * index(node) * y.size(), y.size(), y.data(), u.size(), y.size(), u.data());
  return {u[0], u[1], u[2]};
}

NearField::NearField(const ModelView& view)
    : offset_(view.near_offset), node_(view.near_node), field_(view.near_field) {
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
  const float* const field = field_.data() + 3 * phi.size() * first;
  addWeightedRows(field, 3 * nodes, weight.data(), used(phi), 3 * nodes, u.data());
  return {node_.subspan(first, nodes), u};
}

Vec3 NearField::at(std::int32_t position, std::span<const double> phi,
                   std::int32_t node) const noexcept PALPATE_NONBLOCKING {
  const std::span<const std::int32_t> list = nodes(position);
  const auto place = std::find(list.begin(), list.end(), node) - list.begin();
  Vec3 u = Vec3::Zero();
  if (place == std::ssize(list)) return u;
  const float* field = field_.data() + 3 * (phi.size() * index(offset_[index(position)]) + index(place));
  for (const double weight : phi.first(used(phi))) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) u[axis] += weight * double(field[axis]);
    field += 3 * list.size();
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
