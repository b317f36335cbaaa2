// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/store_modes.h"

#include <cstdint>
#include <vector>

#include "core/base/index.h"

namespace palpate::solver {

namespace {

/// Surface node of each volume node, -1 inside.
std::vector<std::int32_t> surfaceNodeOf(const SolverSetup& setup) {
  std::vector<std::int32_t> surface_node(index(setup.model.nodeCount()), -1);
  for (std::size_t i = 0; i < setup.surface.nodes.size(); ++i)
    surface_node[index(setup.surface.nodes[i])] = static_cast<std::int32_t>(i);
  return surface_node;
}

}  // namespace

void storeModes(const SolverSetup& setup, const Eigen::MatrixXf& X, const Eigen::MatrixXf& Y,
                modelfile::ModelData& data) {
  data.modes_X.assign(X.data(), X.data() + X.size());
  data.modes_Y.assign(Y.data(), Y.data() + Y.size());
  const std::size_t M = setup.positions.nodes.size();
  data.near_offset.assign(M + 1, 0);
  const Eigen::Index C = Y.cols() / static_cast<Eigen::Index>(M);
  const std::vector<std::int32_t> surface_node = surfaceNodeOf(setup);
  data.contact_displacement.resize(3 * static_cast<std::size_t>(Y.cols()));
  for (std::size_t s = 0; s < M; ++s) {
    const Patch& patch = setup.positions.patches[s];
    Eigen::MatrixXd average = Eigen::MatrixXd::Zero(3, X.cols());
    for (std::size_t i = 0; i < patch.nodes.size(); ++i)
      average += patch.weights[i] * X.middleRows<3>(3 * surface_node[index(patch.nodes[i])]).cast<double>();
    const Eigen::Index column = static_cast<Eigen::Index>(s) * C;
    Eigen::Map<Eigen::MatrixXd>(data.contact_displacement.data() + 3 * column, 3, C) =
        average * Y.middleCols(column, C).cast<double>();
  }
}

}  // namespace palpate::solver
