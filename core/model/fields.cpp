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

/// Rows up to the last whose weight is not zero: a linear field costs no more.
std::size_t used(std::span<const double> weight) noexcept {
  std::size_t count = weight.size();
  while (count > 0 && weight[count - 1] == 0.0) --count;
  return count;
}

/// Weight of each row of one source.
Weights scaled(std::span<const double> weight, double factor) noexcept {
  Weights scaled;
  for (std::size_t k = 0; k < weight.size(); ++k) scaled[k] = static_cast<float>(factor * weight[k]);
  return scaled;
}

}  // namespace

void Amplitudes::add(std::int32_t source, std::span<const double> weight, double factor,
                     std::span<float> y) const noexcept PALPATE_NONBLOCKING {
  const Weights row = scaled(weight, factor);
  const std::size_t first = index(source) * rows_;
  palpate::addRows({Y_.data() + first * modes_, scale_.data() + first, used(weight), modes_}, row.data(),
                   y.data());
}

void Amplitudes::addRow(std::int32_t source, std::size_t row, double factor,
                        std::span<float> y) const noexcept {
  const std::size_t at = index(source) * rows_ + row;
  const float weight = static_cast<float>(factor) * scale_[at];
  const std::int16_t* const from = Y_.data() + at * modes_;
  for (std::size_t k = 0; k < modes_; ++k) y[k] += weight * static_cast<float>(from[k]);
}

void Amplitudes::addRows(std::span<const std::int32_t> source, const double* weight,
                         std::span<float> y) const noexcept PALPATE_NONBLOCKING {
  addGroups({Y_.data(), scale_.data(), rows_, modes_, source.data(), source.size()}, weight, y.data());
}

void Amplitudes::addTogether(std::int32_t source, std::span<const float> weight,
                             std::span<float> y) const noexcept PALPATE_NONBLOCKING {
  const std::size_t first = index(source) * rows_;
  addRowsTogether({Y_.data() + first * modes_, scale_.data() + first, rows_, modes_}, weight.data(),
                  y.data());
}

SeparatedField::SeparatedField(const ModelView& view)
    : X_(view.modes_X),
      X_scale_(view.modes_X_scale),
      modes_(static_cast<int>(view.modes())),
      by_node_(X_.size()) {
  const std::size_t n = view.modes(), numbers = 3 * view.surfaceNodes();
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < numbers; ++i)
      by_node_[i * n + k] = X_scale_[k] * static_cast<float>(X_[k * numbers + i]);
  chooseKernels();
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

void SeparatedField::addNode(int node, float weight, std::span<float> x) const noexcept {
  const float* const from = by_node_.data() + index(node) * x.size();
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += weight * from[i];
}

void SeparatedField::average(std::span<const std::int32_t> node, std::span<const float> weight,
                             std::span<float> x) const noexcept PALPATE_NONBLOCKING {
  mixRowsTogether({by_node_.data(), 3 * index(modes_), node.data(), node.size()}, weight.data(), x.data());
}

NearField::NearField(const Arrays& arrays, std::size_t rows) : arrays_(arrays), rows_(rows) {
  for (std::size_t m = 0; m + 1 < arrays.offset.size(); ++m)
    block_size_ = std::max(block_size_, 3 * index(arrays.offset[m + 1] - arrays.offset[m]));
}

std::span<const std::int32_t> NearField::nodes(std::int32_t source) const noexcept PALPATE_NONBLOCKING {
  const std::size_t m = index(source), first = index(arrays_.offset[m]);
  return arrays_.node.subspan(first, index(arrays_.offset[m + 1]) - first);
}

NearField::Block NearField::block(std::int32_t source, std::span<const double> weight, double factor,
                                  std::span<float> scratch) const noexcept PALPATE_NONBLOCKING {
  const std::size_t m = index(source);
  const std::span<const std::int32_t> list = nodes(source);
  const std::span<float> u = scratch.first(3 * list.size());
  std::fill(u.begin(), u.end(), 0.0F);
  const Weights row = scaled(weight, factor);
  const std::int16_t* const field = arrays_.field.data() + 3 * rows_ * index(arrays_.offset[m]);
  palpate::addRows({field, arrays_.scale.data() + m * rows_, used(weight), u.size()}, row.data(), u.data());
  return {list, u};
}

std::ptrdiff_t NearField::find(std::int32_t source, std::int32_t node) const noexcept PALPATE_NONBLOCKING {
  const std::span<const std::int32_t> list = nodes(source);
  const auto found = std::lower_bound(list.begin(), list.end(), node);
  return found == list.end() || *found != node ? -1 : found - list.begin();
}

Vec3 NearField::at(std::int32_t source, std::span<const double> weight,
                   std::int32_t node) const noexcept PALPATE_NONBLOCKING {
  Vec3 u = Vec3::Zero();
  const std::ptrdiff_t place = find(source, node);
  if (place < 0) return u;
  const std::size_t m = index(source), stride = 3 * nodes(source).size();
  const std::int16_t* field = arrays_.field.data() + 3 * (rows_ * index(arrays_.offset[m]) + index(place));
  for (std::size_t k = 0; k < used(weight); ++k, field += stride) {
    const double factor = weight[k] * double(arrays_.scale[m * rows_ + k]);
    for (Eigen::Index axis = 0; axis < 3; ++axis) u[axis] += factor * field[axis];
  }
  return u;
}

Vec3 NearField::rowAt(std::int32_t source, std::size_t row, std::int32_t node) const noexcept {
  const std::ptrdiff_t place = find(source, node);
  if (place < 0) return Vec3::Zero();
  const std::size_t m = index(source), count = nodes(source).size();
  const std::int16_t* const field =
      arrays_.field.data() + 3 * (rows_ * index(arrays_.offset[m]) + row * count + index(place));
  return double(arrays_.scale[m * rows_ + row]) * Vec3(field[0], field[1], field[2]);
}

void NearField::addRows(std::int32_t source, double factor, std::int32_t node,
                        Mat3& u) const noexcept PALPATE_NONBLOCKING {
  const std::ptrdiff_t place = find(source, node);
  if (place < 0) return;
  const std::size_t m = index(source), stride = 3 * nodes(source).size();
  const std::int16_t* field = arrays_.field.data() + 3 * (3 * index(arrays_.offset[m]) + index(place));
  for (std::size_t r = 0; r < 3; ++r, field += stride) {
    const double weight = factor * double(arrays_.scale[3 * m + r]);
    for (Eigen::Index axis = 0; axis < 3; ++axis) u(axis, Eigen::Index(r)) += weight * field[axis];
  }
}

void NearField::add(std::int32_t source, std::span<const double> weight, double factor,
                    std::span<float> scratch, std::span<float> u) const noexcept PALPATE_NONBLOCKING {
  const Block near = block(source, weight, factor, scratch);
  for (std::size_t i = 0; i < near.nodes.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) u[3 * index(near.nodes[i]) + axis] += near.u[3 * i + axis];
}

void NearField::findTogether(std::int32_t source, std::span<const float> weight,
                             std::span<float> u) const noexcept PALPATE_NONBLOCKING {
  const std::size_t m = index(source), length = 3 * nodes(source).size();
  std::fill_n(u.begin(), kTogether * length + 1, 0.0F);
  addRowsTogether({arrays_.field.data() + 3 * rows_ * index(arrays_.offset[m]),
                   arrays_.scale.data() + m * rows_, weight.size() / kTogether, length},
                  weight.data(), u.data());
}

std::vector<Vec3> pointsOf(std::span<const double> positions, std::span<const std::int32_t> nodes) {
  std::vector<Vec3> points;
  for (const std::int32_t node : nodes)
    points.emplace_back(Eigen::Map<const Vec3>(positions.data() + 3 * index(node)));
  return points;
}

double NearField::reach(std::span<const Vec3> source, std::span<const double> positions) const {
  double farthest = 0.0;
  for (std::size_t m = 0; m < source.size(); ++m)
    for (const std::int32_t node : nodes(static_cast<std::int32_t>(m)))
      farthest =
          std::max(farthest, (Eigen::Map<const Vec3>(positions.data() + 3 * index(node)) - source[m]).norm());
  return farthest;
}

}  // namespace palpate
