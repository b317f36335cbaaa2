// SPDX-License-Identifier: Apache-2.0
#include "core/model/linear_field.h"

#include <algorithm>
#include <array>

#include "core/base/index.h"
#include "core/base/whole_kernels.h"

namespace palpate {

namespace {

constexpr std::size_t kLoads = 3;

using Loads = std::array<double, kLoads>;

/// What a source answers for, by direction.
Loads loadOf(const PatchSources& from, std::size_t i, const Vec3& f) noexcept PALPATE_NONBLOCKING {
  const Vec3 load = from.weight[i] * f;
  return {load.x(), load.y(), load.z()};
}

constexpr std::array<std::int32_t, 2> kNone{-1, -1};

}  // namespace

LinearField::LinearField(const ModelView& view)
    : sources_(view.surfaceNodes(), kNone),
      greens_(view.green_node.size()),
      amplitudes_(view.green_Y, view.green_Y_scale, kLoads, view.modes()),
      nodes_{view.green_offset, view.green_near_node},
      near_(view.green_near),
      near_scale_(view.green_near_scale) {
  for (std::size_t g = 0; g < view.green_node.size(); ++g)
    sources_[index(view.green_node[g])][0] = static_cast<std::int32_t>(g);
  for (std::size_t f = 0; view.contactTriangles() < view.triangles() && f < view.contactTriangles(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {  // the middle of the edge across from corner k
      std::array<std::int32_t, 2>& middle = sources_[index(view.surface_triangles[12 * f + 9 + k])];
      const auto end = [&](std::size_t turn) {
        return sources_[index(view.contact_triangles[3 * f + (k + turn) % 3])][0];
      };
      if (middle != kNone || end(1) < 0 || end(2) < 0) continue;
      middle = {end(1), end(2)};
      shares_loads_ = true;
    }
  reach_ = nodes_.reach(pointsOf(view.surface_positions, view.green_node), view.surface_positions);
}

PatchSources LinearField::room(std::size_t nodes) const {
  const std::size_t most = std::min(2 * nodes, greens_);
  return {0, std::vector<std::int32_t>(most), std::vector<double>(most),
          std::vector<std::int32_t>(greens_, -1)};
}

void LinearField::find(const PatchNodes& patch, PatchSources& out) const noexcept PALPATE_NONBLOCKING {
  out.count = 0;
  for (std::size_t i = 0; i < patch.count; ++i) {
    const std::array<std::int32_t, 2>& sources = sources_[index(patch.node[i])];
    const double share = sources[1] >= 0 ? 0.5 : 1.0;
    for (const std::int32_t source : sources) {
      if (source < 0) continue;
      std::int32_t& place = out.place[index(source)];
      if (place < 0) {
        place = static_cast<std::int32_t>(out.count++);
        out.source[index(place)] = source;
        out.weight[index(place)] = 0.0;
      }
      out.weight[index(place)] += share * patch.weight[i];
    }
  }
  for (std::size_t i = 0; i < out.count; ++i) out.place[index(out.source[i])] = -1;
}

void LinearField::addAmplitudes(const PatchSources& from, const Vec3& f,
                                std::span<float> y) const noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < from.count; ++i) amplitudes_.add(from.source[i], loadOf(from, i, f), 1.0, y);
}

void LinearField::addUnitAmplitudes(const PatchSources& from,
                                    std::span<float> y) const noexcept PALPATE_NONBLOCKING {
  amplitudes_.addRows(std::span(from.source).first(from.count), from.weight.data(), y);
}

void LinearField::addNear(const PatchSources& from, const Vec3& f, UnitNear& unit,
                          std::span<float> u) const noexcept PALPATE_NONBLOCKING {
  findUnitNear(from, unit);
  const Eigen::Vector3f load = f.cast<float>();
  for (const std::int32_t node : unit.sum.reached())
    Eigen::Map<Eigen::Vector3f>(u.data() + 3 * index(node)) += unit.sum.matrixAt(node) * load;
}

Mat3 LinearField::nearAt(const PatchSources& from, std::int32_t node) const noexcept PALPATE_NONBLOCKING {
  Mat3 u = Mat3::Zero();
  for (std::size_t i = 0; i < from.count; ++i) {
    const std::ptrdiff_t place = nodes_.find(from.source[i], node);
    if (place < 0) continue;
    const std::size_t first = kMatrixNumbers * index(place);
    for (std::size_t load = 0; load < kLoads; ++load) {
      const double weight = from.weight[i] * double(near_scale_[kLoads * index(from.source[i]) + load]);
      for (std::size_t axis = 0; axis < 3; ++axis)
        u(Eigen::Index(axis), Eigen::Index(load)) += weight * near_[first + 3 * load + axis];
    }
  }
  return u;
}

UnitNear LinearField::unitNear(std::size_t nodes, const PatchSources& sources) {
  return {NodeSum(nodes), 0, std::vector<std::int32_t>(sources.source.size())};
}

void LinearField::findUnitNear(const PatchSources& from, UnitNear& unit) const noexcept PALPATE_NONBLOCKING {
  const std::span<const std::int32_t> sources = std::span(from.source).first(from.count);
  const std::span<const std::int32_t> known = std::span(unit.source).first(unit.count);
  if (std::equal(sources.begin(), sources.end(), known.begin(), known.end())) {
    unit.sum.zero();
  } else {
    unit.sum.clear();
    for (const std::int32_t source : sources) unit.sum.reach(nodes_.of(source));
    std::copy(sources.begin(), sources.end(), unit.source.begin());
    unit.count = sources.size();
  }
  const auto matricesOf = [&](std::size_t i) noexcept PALPATE_NONBLOCKING {
    return near_.from(kMatrixNumbers * index(nodes_.offset[index(from.source[i])]));
  };
  for (std::size_t i = 0; i < from.count; ++i) {
    if (i + 1 < from.count)  // which lies elsewhere
      matricesOf(i + 1).expect(kMatrixNumbers * nodes_.of(from.source[i + 1]).size());
    std::array<float, kNodeFloats> weight{};
    for (std::size_t load = 0; load < kLoads; ++load)
      std::fill_n(weight.data() + 3 * load, 3,
                  static_cast<float>(from.weight[i]) * near_scale_[kLoads * index(from.source[i]) + load]);
    const std::span<const std::int32_t> nodes = nodes_.of(from.source[i]);
    addMatrices(matricesOf(i), nodes.data(), nodes.size(), weight, unit.sum.data());
  }
}

}  // namespace palpate
