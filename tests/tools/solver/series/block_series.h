// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "../boxes.h"
#include "tools/solver/fem/newton.h"
#include "tools/solver/series/series.h"

namespace palpate::solver {

/// sum over k of value[k] c(k), c(k) in R^3.
template <typename Coefficient>
Vec3 sum(const MonomialBasis& basis, const Vec3& x, Coefficient c) {
  std::vector<double> value(static_cast<std::size_t>(basis.size()));
  basis.evaluate(x, value);
  Vec3 total = Vec3::Zero();
  for (int k = 0; k < basis.size(); ++k) total += value[static_cast<std::size_t>(k)] * c(k);
  return total;
}

class BlockSeries : public ::testing::Test {
 public:
  static constexpr int kOrder = 4;
  const Box box_{6, 5, 4, Vec3(0.06, 0.05, 0.04)};

  struct Case {
    Case(const Box& box, double E, Law law = {}) : Case(box, Material{{E, 0.45}, law}) {}
    Case(const Box& box, const Material& material, const std::vector<Spring>& springs = {})
        : model(box.nodes(), {box.tetrahedra()}, box.face(0, false), material, springs),
          surface(box.surface(model)),
          factor(model) {
      factor.factorize(Eigen::VectorXd::Zero(3 * model.nodeCount()));
      for (const int node : {box.node(4, 2, 4), box.node(6, 3, 2), box.node(3, 5, 2)}) {
        const auto at = std::find(surface.nodes.begin(), surface.nodes.end(), node) - surface.nodes.begin();
        patches.push_back(makePatch(model, surface, surface.atNode(static_cast<int>(at)), 0.012));
      }
    }
    FeModel model;
    PatchSurface surface;
    Cholesky factor;
    std::vector<Patch> patches;
  };

  static Eigen::VectorXd field(const SeriesSolver& series, int lane, const Vec3& d, const FeModel& model) {
    std::vector<double> value(static_cast<std::size_t>(series.basis().size()));
    series.basis().evaluate(d, value);
    Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * model.nodeCount());
    for (int node = 0; node < model.nodeCount(); ++node)
      for (int k = 0; k < series.basis().size(); ++k)
        u.segment<3>(3 * node) += value[static_cast<std::size_t>(k)] * series.displacement(lane, k, node);
    return u;
  }

  static Vec3 force(const SeriesSolver& series, int lane, const Vec3& d) {
    std::vector<double> value(static_cast<std::size_t>(series.answerBasis().size()));
    series.answerBasis().evaluate(d, value);
    Vec3 f = Vec3::Zero();
    for (int k = 0; k < series.answerBasis().size(); ++k)
      f += value[static_cast<std::size_t>(k)] * series.answer(lane, k);
    return f;
  }
};

}  // namespace palpate::solver
