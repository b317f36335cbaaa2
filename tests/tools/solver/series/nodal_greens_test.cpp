// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/series/nodal_greens.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <numeric>

#include "../boxes.h"
#include "tools/solver/series/series.h"

namespace palpate::solver {
namespace {

class BlockGreens : public ::testing::Test {
 protected:
  BlockGreens() {
    factor_.factorize(Eigen::VectorXd::Zero(3 * model_.nodeCount()));
    std::vector<std::int32_t> nodes(surface_.nodes.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    NodalGreens greens(model_, factor_, surface_);
    for (std::size_t first = 0; first < nodes.size(); first += NodalGreens::kMost) {
      const std::size_t count = std::min(NodalGreens::kMost, nodes.size() - first);
      greens.solve(std::span(nodes).subspan(first, count));
      for (std::size_t i = 0; i < count; ++i) W_.push_back(greens.of(i));
    }
  }

  /// W_s = sum w_i W_i at the surface nodes, and C_s = sum w_j W_s(j).
  void superpose(const ContactPoint& s, Eigen::MatrixXd& W, Mat3& C) const {
    const Patch patch = makePatch(model_, surface_, s, kWidth);
    W.setZero(static_cast<Eigen::Index>(3 * surface_.nodes.size()), 3);
    C.setZero();
    for (std::size_t i = 0; i < patch.nodes.size(); ++i) W += patch.weights[i] * W_[at(patch.nodes[i])];
    for (std::size_t i = 0; i < patch.nodes.size(); ++i)
      C += patch.weights[i] * W.middleRows<3>(static_cast<Eigen::Index>(3 * at(patch.nodes[i])));
  }

  std::size_t at(std::int32_t volume_node) const {
    return static_cast<std::size_t>(std::find(surface_.nodes.begin(), surface_.nodes.end(), volume_node) -
                                    surface_.nodes.begin());
  }

  static constexpr double kWidth = 0.012;
  const Box box_{6, 5, 4, Vec3(0.06, 0.05, 0.04)};
  const FeModel model_{box_.clamped({{160e3, 0.45}})};
  const PatchSurface surface_{box_.surface(model_)};
  Cholesky factor_{model_};
  std::vector<Eigen::MatrixXd> W_;
};

TEST_F(BlockGreens, SuperposedTheyAreThePatchsOwnSolveAtNodesAndBetweenThem) {
  std::vector<ContactPoint> points;
  for (const int node : {box_.node(4, 2, 4), box_.node(6, 3, 2), box_.node(1, 5, 2)})
    points.push_back(surface_.atNode(static_cast<int>(at(node))));
  for (const int t : {20, 60, 110}) points.push_back({t, {0.2, 0.5, 0.3}});
  SeriesSolver series(model_, factor_, 1);
  for (const ContactPoint& s : points) {
    const std::array<Patch, 1> patch{makePatch(model_, surface_, s, kWidth)};
    series.solve(patch);
    Eigen::MatrixXd W;
    Mat3 C;
    superpose(s, W, C);
    const Mat3 K = C.inverse();
    const Eigen::MatrixXd u = W * K;
    double worst = 0.0;
    for (int k = 0; k < 3; ++k) {
      EXPECT_LT((series.answer(0, k) - K.col(k)).norm(), 1e-10 * K.norm());
      for (std::size_t j = 0; j < surface_.nodes.size(); ++j)
        worst = std::max(worst, (u.block<3, 1>(static_cast<Eigen::Index>(3 * j), k) -
                                 series.displacement(0, k, surface_.nodes[j]))
                                    .norm());
    }
    EXPECT_LT(worst, 1e-10);
    EXPECT_GT(u.cwiseAbs().maxCoeff(), 0.5);
  }
}

TEST_F(BlockGreens, AreReciprocalAndZeroOfClampedNodes) {
  int clamped = 0;
  for (std::size_t i = 0; i < W_.size(); i += 7)
    for (std::size_t j = 0; j < i; j += 5) {
      const Mat3 there = W_[i].middleRows<3>(static_cast<Eigen::Index>(3 * j));
      const Mat3 back = W_[j].middleRows<3>(static_cast<Eigen::Index>(3 * i));
      EXPECT_LT((there - back.transpose()).norm(), 1e-10 * W_[i].cwiseAbs().maxCoeff() + 1e-30);
    }
  for (std::size_t i = 0; i < W_.size(); ++i) {
    const bool held = !model_.isFree(surface_.nodes[i]);
    EXPECT_EQ(W_[i].cwiseAbs().maxCoeff() == 0.0, held) << i;
    clamped += held ? 1 : 0;
  }
  EXPECT_GT(clamped, 10);
}

}  // namespace
}  // namespace palpate::solver
