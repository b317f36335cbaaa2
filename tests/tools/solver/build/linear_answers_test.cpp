// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/linear_answers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include "core/surface/smooth_places.h"
#include "tools/mesh/box_mesh.h"
#include "tools/solver/series/nodal_greens.h"
#include "tools/solver/series/series.h"

namespace palpate::solver {
namespace {

class BlockStiffness : public ::testing::Test {
 protected:
  static Case makeCase() {
    Case c;
    c.mesh = "block";
    c.patch_radius = 0.01;
    return c;
  }
  static mesh::TetMesh makeMesh() {
    mesh::TetMesh organ = mesh::makeBox(Vec3(0.06, 0.05, 0.04), {7, 6, 5});
    for (std::int32_t node = 0; node < static_cast<std::int32_t>(organ.nodes.size()); ++node)
      if (organ.nodes[static_cast<std::size_t>(node)].x() < 1e-9) organ.groups["fixed"].push_back(node);
    return organ;
  }
  static std::vector<std::int32_t> allNodes(const PatchSurface& surface) {
    std::vector<std::int32_t> nodes(surface.nodes.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    return nodes;
  }

  BlockStiffness() {
    factor_.factorize(Eigen::VectorXd::Zero(3 * setup_.model.nodeCount()));
    series_.emplace(setup_.model, factor_, 1);
    const std::vector<std::int32_t> nodes = allNodes(setup_.surface);
    const ContactPatches patches(setup_.surface.graph, freeNodes(setup_.model, setup_.surface),
                                 setup_.patch_radius, setup_.positions.nodes);
    CloseGreens close(setup_.surface, nodes, 6.5 * setup_.patch_radius);
    NodalGreens greens(setup_.model, factor_, setup_.surface);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      greens.solve(std::span(nodes).subspan(i, 1));
      close.keep(i, (greens.of(0)).cast<float>());
    }
    stiffness_ = patchStiffness(setup_, patches, close, 2);
    std::vector<std::int32_t> position(nodes.size(), -1);
    for (std::size_t p = 0; p < setup_.positions.nodes.size(); ++p)
      position[static_cast<std::size_t>(setup_.positions.nodes[p])] = static_cast<std::int32_t>(p);
    const auto& triangles = setup_.surface.triangles;
    places_ = std::make_unique<SmoothPlaces>(
        std::span(setup_.surface.positions.front().data(), 3 * setup_.surface.positions.size()),
        std::span(triangles.front().data(), 3 * triangles.size()), position);
  }

  /// The stiffness of one patch, by a solve of its own in double precision.
  Mat3 solved(const ContactPoint& s) {
    const std::array<Patch, 1> patch{makePatch(setup_.model, setup_.surface, s, setup_.patch_radius)};
    series_->solve(patch);
    Mat3 K;
    for (int k = 0; k < 3; ++k) K.col(k) = series_->answer(0, k);
    return K;
  }
  /// K of a place, or its derivative along an axis: part 0, or 1 + axis.
  Mat3 stored(std::size_t place, std::size_t part) const {
    Mat3 K;
    std::size_t entry = 0;
    for (Eigen::Index i = 0; i < 3; ++i)
      for (Eigen::Index j = i; j < 3; ++j) K(i, j) = K(j, i) = stiffness_[24 * place + 4 * entry++ + part];
    return K;
  }

  const mesh::TetMesh mesh_{makeMesh()};
  const SolverSetup setup_{makeCase(), mesh_};
  Cholesky factor_{setup_.model};
  std::optional<SeriesSolver> series_;  // of the factor, once there is one
  std::vector<double> stiffness_;
  std::unique_ptr<SmoothPlaces> places_;
};

TEST_F(BlockStiffness, IsThatOfASolveOfItsOwnAtNodesAndMiddlesOfEdges) {
  ASSERT_EQ(stiffness_.size(), 24 * places_->size());
  ASSERT_GT(places_->size(), 3 * setup_.positions.nodes.size());
  for (std::size_t place = 0; place < places_->size(); place += 11) {
    const Mat3 K = solved(places_->views(place).front().s);
    EXPECT_LT((stored(place, 0) - K).norm(), 1e-6 * K.norm()) << place;
  }
}

TEST_F(BlockStiffness, ItsGradientIsTheMeanOfThoseInTheTrianglesRoundAPlace) {
  constexpr double kStep = 1e-4;
  for (std::size_t place = 3; place < places_->size(); place += 37) {
    std::array<Mat3, 3> mean{Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};
    for (const SmoothPlaces::View& view : places_->views(place)) {
      std::array<Mat3, 3> by_lambda{Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};
      const Mat3 here = solved(view.s);
      std::size_t from = 0;  // a corner that has weight to give
      while (view.s.barycentric[from] < 0.4) ++from;
      for (std::size_t k = 0; k < 3; ++k) {
        if (k == from) continue;
        ContactPoint one = view.s, two = view.s;
        one.barycentric[k] += kStep, one.barycentric[from] -= kStep;
        two.barycentric[k] += 2.0 * kStep, two.barycentric[from] -= 2.0 * kStep;
        by_lambda[k] = (4.0 * solved(one) - solved(two) - 3.0 * here) / (2.0 * kStep);
      }
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < 3; ++k)
          mean[axis] += view.share * view.slopes(Eigen::Index(k), Eigen::Index(axis)) * by_lambda[k];
    }
    double size = 0.0;
    for (const Mat3& part : mean) size += part.norm();
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_LT((stored(place, 1 + axis) - mean[axis]).norm(), 1e-4 * size) << place;
    EXPECT_GT(size, 1.0) << "N/m^2";
  }
}

}  // namespace
}  // namespace palpate::solver
