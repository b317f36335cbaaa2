// SPDX-License-Identifier: Apache-2.0
#include "core/model/fields.h"

#include <algorithm>
#include <array>

#include "core/base/index.h"
#include "core/base/multi_index.h"
#include "core/base/whole_kernels.h"

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
  palpate::addRows({Y_.from(first * modes_), scale_.data() + first, used(weight), modes_}, row.data(),
                   y.data());
}

void Amplitudes::addRow(std::int32_t source, std::size_t row, double factor,
                        std::span<float> y) const noexcept {
  const auto weight = static_cast<float>(factor);
  const std::size_t at = index(source) * rows_ + row;
  palpate::addRows({Y_.from(at * modes_), scale_.data() + at, 1, modes_}, &weight, y.data());
}

void Amplitudes::addRows(std::span<const std::int32_t> source, const double* weight,
                         std::span<float> y) const noexcept PALPATE_NONBLOCKING {
  addGroups({Y_, scale_.data(), rows_, modes_, source.data(), source.size()}, weight, y.data());
}

void Amplitudes::addTogether(std::int32_t source, std::span<const float> weight,
                             std::span<float> y) const noexcept PALPATE_NONBLOCKING {
  const std::size_t first = index(source) * rows_;
  addRowsTogether({Y_.from(first * modes_), scale_.data() + first, rows_, modes_}, weight.data(), y.data());
}

SeparatedField::SeparatedField(const ModelView& view) : X_(view.modes_X), scale_(view.modes_X_scale) {
  chooseKernels();
}

void SeparatedField::weigh(std::span<float> y) const noexcept PALPATE_NONBLOCKING {
  for (std::size_t k = 0; k < scale_.size(); ++k) y[k] *= scale_[k];
}

void SeparatedField::expand(std::span<const float> y, std::span<float> u) const noexcept PALPATE_NONBLOCKING {
  dotRows(X_, y.data(), u.size(), y.size(), u.data());
}

Vec3 SeparatedField::at(std::span<const float> y, int node) const noexcept PALPATE_NONBLOCKING {
  std::array<float, 3> u{};
  dotRows(X_.from(3 * index(node) * y.size()), y.data(), u.size(), y.size(), u.data());
  return {u[0], u[1], u[2]};
}

void SeparatedField::addNode(int node, float weight, std::span<float> x) const noexcept {
  constexpr float kNoScale = 1.0F;
  palpate::addRows({X_.from(index(node) * x.size()), &kNoScale, 1, x.size()}, &weight, x.data());
}

void SeparatedField::average(std::span<const std::int32_t> node, std::span<const float> weight,
                             std::span<float> x) const noexcept PALPATE_NONBLOCKING {
  const std::size_t n = scale_.size();
  mixRowsTogether({X_, 3 * n, node.data(), node.size()}, weight.data(), x.data());
  for (std::size_t row = 0; row < 3 * kTogether; ++row) weigh(x.subspan(row * n, n));
}

std::span<const std::int32_t> NearNodes::of(std::int32_t source) const noexcept PALPATE_NONBLOCKING {
  const std::size_t m = index(source), first = index(offset[m]);
  return node.subspan(first, index(offset[m + 1]) - first);
}

std::ptrdiff_t NearNodes::find(std::int32_t source, std::int32_t wanted) const noexcept PALPATE_NONBLOCKING {
  const std::span<const std::int32_t> list = of(source);
  const auto found = std::lower_bound(list.begin(), list.end(), wanted);
  if (found == list.end() || *found != wanted) return -1;
  return std::ptrdiff_t(offset[index(source)]) + (found - list.begin());
}

std::size_t NearNodes::most() const noexcept {
  std::size_t most = 0;
  for (std::size_t m = 0; m + 1 < offset.size(); ++m) most = std::max(most, index(offset[m + 1] - offset[m]));
  return most;
}

double NearNodes::reach(std::span<const Vec3> source, std::span<const double> positions) const {
  double farthest = 0.0;
  for (std::size_t m = 0; m < source.size(); ++m)
    for (const std::int32_t near : of(static_cast<std::int32_t>(m)))
      farthest =
          std::max(farthest, (Eigen::Map<const Vec3>(positions.data() + 3 * index(near)) - source[m]).norm());
  return farthest;
}

NearField::Block NearField::block(std::int32_t source, std::span<const double> weight, double factor,
                                  std::span<float> scratch) const noexcept PALPATE_NONBLOCKING {
  const std::size_t m = index(source);
  const std::span<const std::int32_t> list = nodes(source);
  const std::span<float> u = scratch.first(3 * list.size());
  std::fill(u.begin(), u.end(), 0.0F);
  const Weights row = scaled(weight, factor);
  palpate::addRows(
      {field_.from(3 * rows_ * index(nodes_.offset[m])), scale_.data() + m * rows_, used(weight), u.size()},
      row.data(), u.data());
  return {list, u};
}

std::size_t NearField::numbersOf(std::int32_t source,
                                 std::ptrdiff_t place) const noexcept PALPATE_NONBLOCKING {
  const std::size_t first = index(nodes_.offset[index(source)]);
  return 3 * (rows_ * first + (index(place) - first));
}

Vec3 NearField::at(std::int32_t source, std::span<const double> weight,
                   std::int32_t node) const noexcept PALPATE_NONBLOCKING {
  Vec3 u = Vec3::Zero();
  const std::ptrdiff_t place = nodes_.find(source, node);
  if (place < 0) return u;
  const std::size_t m = index(source), stride = 3 * nodes(source).size();
  std::size_t number = numbersOf(source, place);
  for (std::size_t k = 0; k < used(weight); ++k, number += stride) {
    const double factor = weight[k] * double(scale_[m * rows_ + k]);
    for (std::size_t axis = 0; axis < 3; ++axis) u[Eigen::Index(axis)] += factor * field_[number + axis];
  }
  return u;
}

void NearField::addRowsAt(std::int32_t source, double factor, std::int32_t node,
                          std::span<Vec3> u) const noexcept {
  const std::ptrdiff_t place = nodes_.find(source, node);
  if (place < 0) return;
  const std::size_t stride = 3 * nodes(source).size();
  const float* const scale = scale_.data() + index(source) * rows_;
  std::size_t number = numbersOf(source, place);
  for (std::size_t row = 0; row < u.size(); ++row, number += stride)
    u[row] += factor * double(scale[row]) * Vec3(field_[number], field_[number + 1], field_[number + 2]);
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
  addRowsTogether({field_.from(3 * rows_ * index(nodes_.offset[m])), scale_.data() + m * rows_,
                   weight.size() / kTogether, length},
                  weight.data(), u.data());
}

std::vector<Vec3> pointsOf(std::span<const double> positions, std::span<const std::int32_t> nodes) {
  std::vector<Vec3> points;
  for (const std::int32_t node : nodes)
    points.emplace_back(Eigen::Map<const Vec3>(positions.data() + 3 * index(node)));
  return points;
}

}  // namespace palpate
