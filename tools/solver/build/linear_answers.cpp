// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/linear_answers.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/base/index.h"
#include "core/surface/smooth_places.h"
#include "tools/solver/base/blocks.h"
#include "tools/solver/base/parallel.h"

namespace palpate::solver {

namespace {

using Eigen::Matrix3d;

/// K at one place, and its gradient over the surface.
struct Stiffness {
  Matrix3d value = Matrix3d::Zero();
  std::array<Matrix3d, 3> gradient{Matrix3d::Zero(), Matrix3d::Zero(), Matrix3d::Zero()};  // d/dx, y, z
};

/// Adds what one triangle sees. @return false when the compliance is not positive definite
bool addView(const SmoothPlaces::View& view, const PatchNodes& patch, const std::vector<Matrix3d>& Q,
             Stiffness& sum) {
  Matrix3d C = Matrix3d::Zero();
  std::array<Matrix3d, 3> by_lambda{Matrix3d::Zero(), Matrix3d::Zero(), Matrix3d::Zero()};
  for (std::size_t i = 0; i < patch.count; ++i) {
    C += patch.weight[i] * Q[i];
    for (std::size_t k = 0; k < 3; ++k) by_lambda[k] += patch.slope[i][Eigen::Index(k)] * Q[i];
  }
  C = (0.5 * (C + C.transpose())).eval();
  if (C.llt().info() != Eigen::Success) return false;
  const Matrix3d K = C.inverse();
  sum.value += view.share * K;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Matrix3d& half = by_lambda[static_cast<std::size_t>(k)];
    const Matrix3d change = -K * (half + half.transpose()) * K;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      sum.gradient[static_cast<std::size_t>(axis)] += view.share * view.slopes(k, axis) * change;
  }
  return true;
}

std::span<const double> numbers(const std::vector<Vec3>& points) {
  return {points.front().data(), 3 * points.size()};
}

std::vector<std::int32_t> positionOfNode(const SolverSetup& setup) {
  std::vector<std::int32_t> position(setup.surface.nodes.size(), -1);
  for (std::size_t p = 0; p < setup.positions.nodes.size(); ++p)
    position[index(setup.positions.nodes[p])] = static_cast<std::int32_t>(p);
  return position;
}

}  // namespace

CloseGreens::CloseGreens(const PatchSurface& surface, std::span<const std::int32_t> sources, double reach)
    : source_of_(surface.nodes.size(), -1) {
  for (std::size_t i = 0; i < sources.size(); ++i)
    source_of_[index(sources[i])] = static_cast<std::int32_t>(i);
  first_.push_back(0);
  for (const std::int32_t source : sources) {
    for (std::size_t j = 0; j < surface.nodes.size(); ++j)
      if ((surface.positions[j] - surface.positions[index(source)]).norm() < reach)
        node_.push_back(static_cast<std::int32_t>(j));
    first_.push_back(node_.size());
  }
  block_.resize(node_.size());
}

void CloseGreens::keep(std::size_t which, const Eigen::Ref<const Eigen::MatrixXf>& field) {
  for (std::size_t k = first_[which]; k < first_[which + 1]; ++k)
    block_[k] = field.middleRows<3>(3 * node_[k]);
}

std::span<float> CloseGreens::of(std::size_t which) {
  return {block_[0].data() + 9 * first_[which], 9 * (first_[which + 1] - first_[which])};
}

void CloseGreens::apply(const PatchNodes& patch, std::vector<Matrix3d>& Q) const {
  Q.assign(patch.count, Matrix3d::Zero());
  for (std::size_t i = 0; i < patch.count; ++i) {
    const std::size_t source = index(source_of_[index(patch.node[i])]);
    std::size_t k = first_[source];
    for (std::size_t j = 0; j < patch.count; ++j) {  // both ascending
      while (k < first_[source + 1] && node_[k] < patch.node[j]) ++k;
      if (k < first_[source + 1] && node_[k] == patch.node[j])
        Q[j] += patch.weight[i] * block_[k].cast<double>();
    }
  }
}

std::vector<std::int32_t> loadedNodes(const SolverSetup& setup, const ContactPatches& patches) {
  std::vector<std::int32_t> nodes;
  std::vector<std::uint8_t> near(setup.surface.nodes.size(), 0);
  for (const std::int32_t centre : setup.positions.nodes) patches.markNear(centre, near);
  for (std::size_t i = 0; i < near.size(); ++i)
    if (near[i] != 0) nodes.push_back(static_cast<std::int32_t>(i));
  return nodes;
}

std::vector<double> patchStiffness(const SolverSetup& setup, const ContactPatches& patches,
                                   const CloseGreens& greens, int workers, const Ranks& ranks) {
  const auto& triangles = setup.surface.faces;
  const SmoothPlaces places(numbers(setup.surface.positions),
                            {triangles.front().data(), 3 * triangles.size()}, positionOfNode(setup));
  constexpr std::size_t kNumbers = 24;
  std::vector<double> out(kNumbers * places.size());
  const Blocks blocks(places.size(), ranks);
  parallelFor(workers, blocks.ownEnd() - blocks.ownBegin(), [&](int, std::size_t own_number) {
    const std::size_t place = blocks.ownBegin() + own_number;
    PatchNodes patch = patches.room();
    std::vector<Matrix3d> Q;
    Stiffness K;
    for (const SmoothPlaces::View& view : places.views(place)) {
      patches.at(view.s, true, patch);
      greens.apply(patch, Q);
      if (addView(view, patch, Q, K)) continue;
      const std::int32_t node = triangles[index(view.s.triangle)][0];
      throw std::runtime_error("the compliance of the contact patch beside volume node " +
                               std::to_string(setup.surface.nodes[index(node)]) +
                               " is not positive definite: the mesh there cannot be loaded");
    }
    double* number = out.data() + kNumbers * place;
    for (Eigen::Index i = 0; i < 3; ++i)
      for (Eigen::Index j = i; j < 3; ++j) {
        *number++ = K.value(i, j);
        for (const Matrix3d& part : K.gradient) *number++ = part(i, j);
      }
  });
  share(blocks,
        [&](std::int32_t place) { return std::span(out).subspan(kNumbers * index(place), kNumbers); });
  return out;
}

}  // namespace palpate::solver
