// SPDX-License-Identifier: Apache-2.0
#include "core/model/patch_average.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/base/index.h"
#include "core/base/kernels.h"
#include "core/surface/surface_distance.h"

namespace palpate {

namespace {

/// By surface node: whether it may carry load.
std::vector<bool> freeNodes(const ModelView& view) {
  std::vector<bool> fixed(view.mesh_nodes.size() / 3, false), free;
  for (const std::int32_t node : view.mesh_fixed) fixed[index(node)] = true;
  for (const std::int32_t node : view.mesh_surface_node) free.push_back(!fixed[index(node)]);
  return free;
}

}  // namespace

PatchAverage::PatchAverage(const ModelView& view, const ModelAttributes& attributes) : modes_(view.modes()) {
  constexpr double kLeastRadius = 1e-9;  // m; below, its square vanishes, and no mesh is that fine
  for (const std::int32_t node : view.contact_node)
    centre_.emplace_back(Eigen::Map<const Vec3>(view.surface_positions.data() + 3 * index(node)));
  findPatches(view, std::max(attributes.patch_radius, kLeastRadius));
  averageModes(view);
  measureReach(view);
}

void PatchAverage::findPatches(const ModelView& view, double a) {
  // A hostile file's patches would fill the memory and take all day, those over fixed nodes too.
  std::size_t together = 0;
  const SurfaceGraph graph(view.surface_positions, view.surface_triangles);
  const std::vector<double> area = graph.lumpedAreas();
  const std::vector<bool> free = freeNodes(view);
  SurfaceFront front(graph);
  first_.push_back(0);
  for (const std::int32_t centre : view.contact_node) {
    const std::int32_t t = graph.trianglesOf(centre).front();
    ContactPoint s{t, {}};
    for (std::size_t k = 0; k < 3; ++k) s.barycentric[k] = graph.triangle(t)[k] == centre ? 1.0 : 0.0;
    double sum = 0.0;
    const auto& patch = front.from(s, 3.0 * a);
    together += patch.size();
    if (patch.size() > kMostNodes || together > kMostTogether)
      throw std::invalid_argument("attribute patch_radius is " + std::to_string(a) +
                                  " m, expected one of patches with at most " + std::to_string(kMostNodes) +
                                  " nodes, found " + std::to_string(patch.size()) + ", and all together " +
                                  std::to_string(kMostTogether) + ", found " + std::to_string(together));
    for (const auto& [node, r] : patch) {
      if (!free[index(node)]) continue;
      const double weight = area[index(node)] * std::exp(-0.5 * r * r / (a * a));
      sum += weight;
      node_.push_back(node);
      weight_.push_back(static_cast<float>(weight));
    }
    for (std::size_t i = first_.back(); i < weight_.size(); ++i) weight_[i] *= static_cast<float>(1.0 / sum);
    first_.push_back(node_.size());
  }
}

void PatchAverage::averageModes(const ModelView& view) {
  const std::size_t numbers = 3 * view.surfaceNodes();
  averaged_.resize(3 * centre_.size() * modes_);
  for (std::size_t k = 0; k < modes_; ++k)  // one mode at a time: it stays in the first-level cache
    for (std::size_t m = 0; m < centre_.size(); ++m) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (std::size_t i = first_[m]; i < first_[m + 1]; ++i)
        sum += weight_[i] * Eigen::Map<const Eigen::Matrix<std::int16_t, 3, 1>>(
                                view.modes_X.data() + k * numbers + 3 * index(node_[i]))
                                .cast<float>();
      for (std::size_t axis = 0; axis < 3; ++axis)
        averaged_[(3 * m + axis) * modes_ + k] = view.modes_X_scale[k] * sum[Eigen::Index(axis)];
    }
}

void PatchAverage::measureReach(const ModelView& view) {
  const auto reach = [&](std::size_t m, std::span<const std::int32_t> list) {
    double most = 0.0;
    for (const std::int32_t node : list) {
      const Vec3 X = Eigen::Map<const Vec3>(view.surface_positions.data() + 3 * index(node));
      most = std::max(most, (X - centre_[m]).norm());
    }
    return most;
  };
  for (std::size_t m = 0; m < centre_.size(); ++m) {
    const std::size_t first = index(view.near_offset[m]), count = index(view.near_offset[m + 1]) - first;
    patch_reach_.push_back(reach(m, nodes(static_cast<std::int32_t>(m))));
    near_reach_.push_back(reach(m, view.near_node.subspan(first, count)));
  }
}

std::span<const std::int32_t> PatchAverage::nodes(std::int32_t position) const noexcept PALPATE_NONBLOCKING {
  const std::size_t m = index(position);
  return std::span(node_).subspan(first_[m], first_[m + 1] - first_[m]);
}

std::span<const float> PatchAverage::weights(std::int32_t position) const noexcept PALPATE_NONBLOCKING {
  const std::size_t m = index(position);
  return std::span(weight_).subspan(first_[m], first_[m + 1] - first_[m]);
}

std::size_t PatchAverage::bytes() const noexcept {
  return first_.size() * sizeof(std::size_t) + (node_.size() + weight_.size() + averaged_.size()) * 4 +
         centre_.size() * (sizeof(Vec3) + 2 * sizeof(double));
}

Vec3 PatchAverage::ofModes(const PositionMix& at,
                           std::span<const float> y) const noexcept PALPATE_NONBLOCKING {
  Vec3 sum = Vec3::Zero();
  for (std::size_t a = 0; a < index(at.count); ++a) {
    std::array<float, 3> dots{};
    const float* const row = averaged_.data() + index(at.position[a]) * 3 * modes_;
    dotRows(row, modes_, y.data(), dots.size(), modes_, dots.data());
    sum += at.weight[a] * Eigen::Map<const Eigen::Vector3f>(dots.data()).cast<double>();
  }
  return sum;
}

void PatchAverage::addWeights(const PositionMix& at,
                              std::span<float> table) const noexcept PALPATE_NONBLOCKING {
  for (std::size_t a = 0; a < index(at.count); ++a) {
    const std::size_t m = index(at.position[a]);
    const auto share = static_cast<float>(at.weight[a]);
    for (std::size_t i = first_[m]; i < first_[m + 1]; ++i) table[index(node_[i])] += share * weight_[i];
  }
}

bool PatchAverage::meets(std::int32_t from, const PositionMix& at) const noexcept PALPATE_NONBLOCKING {
  const std::size_t b = index(from);
  for (std::size_t a = 0; a < index(at.count); ++a) {
    const std::size_t m = index(at.position[a]);
    if ((centre_[m] - centre_[b]).norm() <= near_reach_[b] + patch_reach_[m]) return true;
  }
  return false;
}

}  // namespace palpate
