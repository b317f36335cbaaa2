// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/displacement_fields.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/multi_index.h"
#include "tools/solver/base/parallel.h"

namespace palpate::solver {

namespace {

/// The monomials from degree 2 on at abs(d) = x d_ref in 26 directions, C - 3 x 26.
Eigen::MatrixXf bentDirections(const MonomialBasis& basis, double x) {
  Eigen::MatrixXf out(basis.size() - 3, 26);
  std::vector<double> values(static_cast<std::size_t>(basis.size()));
  for (int cell = 0, q = 0; cell < 27; ++cell) {
    const Vec3 way(cell / 9 - 1, cell / 3 % 3 - 1, cell % 3 - 1);
    if (way.isZero()) continue;
    basis.evaluate(x * way.normalized(), values);
    for (Eigen::Index k = 0; k < out.rows(); ++k)
      out(k, q) = static_cast<float>(values[static_cast<std::size_t>(k) + 3]);
    ++q;
  }
  return out;
}

}  // namespace

void storeGreens(const FitProblem& greens, const Eigen::MatrixXf& X, std::span<const NearNodes> near,
                 int workers, modelfile::ModelData& data) {
  const Eigen::MatrixXf amplitudes = amplitudesOf(greens, X, workers);
  const std::size_t n = static_cast<std::size_t>(X.cols());
  data.green_offset.push_back(0);
  for (const NearNodes& one : near) {
    data.green_offset.push_back(data.green_offset.back() + static_cast<std::int64_t>(one.nodes.size()));
    data.green_near_node.insert(data.green_near_node.end(), one.nodes.begin(), one.nodes.end());
  }
  data.green_Y.resize(near.size() * 3 * n);
  data.green_near.resize(9 * data.green_near_node.size());
  const Blocks& blocks = greens.table.blocks();
  parallelFor(workers, blocks.ownEnd() - blocks.ownBegin(), [&](int, std::size_t own_number) {
    const auto i = static_cast<std::size_t>(blocks.order()[blocks.ownBegin() + own_number]);
    std::vector<float> fields(3 * greens.table.rows());
    greens.table.read(i, fields);
    const Eigen::MatrixXf Y =  // the fit counts in units of the reference
        amplitudes.middleCols(static_cast<Eigen::Index>(3 * i), 3) / static_cast<float>(greens.reference);
    Eigen::Map<Eigen::MatrixXf>(data.green_Y.data() + 3 * n * i, X.cols(), 3) = Y;
    const Eigen::Map<const Eigen::MatrixXf> U(fields.data(), static_cast<Eigen::Index>(greens.table.rows()),
                                              3);
    const NearNodes& own = near[i];
    const std::size_t K = own.nodes.size();
    float* const out = data.green_near.data() + 9 * data.green_offset[i];
    for (std::size_t j = 0; j < K; ++j) {
      const Eigen::Index row = 3 * own.nodes[j];
      const Eigen::Matrix3f modes = X.middleRows<3>(row) * Y;
      const Eigen::Matrix3f missed = own.window[j] * (U.middleRows<3>(row) - modes);
      for (std::size_t load = 0; load < 3; ++load)
        Eigen::Map<Eigen::Vector3f>(out + 3 * (load * K + j)) = missed.col(static_cast<Eigen::Index>(load));
    }
  });
  share(blocks, [&](std::int32_t i) {
    return std::span(data.green_Y).subspan(3 * n * static_cast<std::size_t>(i), 3 * n);
  });
  share(blocks, [&](std::int32_t i) {
    const auto first = static_cast<std::size_t>(9 * data.green_offset[static_cast<std::size_t>(i)]);
    return std::span(data.green_near).subspan(first, 9 * near[static_cast<std::size_t>(i)].nodes.size());
  });
}

std::vector<float> storeNearField(const FitProblem& problem, const FarField& far,
                                  std::span<const NearNodes> near, int workers, modelfile::ModelData& data) {
  const FieldTable& table = problem.table;
  const MonomialBasis& basis = problem.basis;
  const std::size_t M = problem.sources.size(), n = static_cast<std::size_t>(far.X.cols());
  const Eigen::Index C = basis.size(), linear = 3;
  data.modes_Y.resize(M * static_cast<std::size_t>(C - linear) * n);
  std::vector<std::vector<std::int32_t>> nodes(M);
  std::vector<std::vector<float>> blocks(M), sizes(M);
  const auto bent = [&](std::size_t position) {
    return far.Y.middleCols(static_cast<Eigen::Index>(position) * C + linear, C - linear);
  };
  for (std::size_t position = 0; position < M; ++position)
    Eigen::Map<Eigen::MatrixXf>(data.modes_Y.data() + position * static_cast<std::size_t>(C - linear) * n,
                                far.Y.rows(), C - linear) = bent(position);
  const Blocks& of_ranks = table.blocks();
  parallelFor(workers, of_ranks.ownEnd() - of_ranks.ownBegin(), [&](int, std::size_t own_number) {
    const auto position = static_cast<std::size_t>(of_ranks.order()[of_ranks.ownBegin() + own_number]);
    std::vector<float> fields(static_cast<std::size_t>(C) * table.rows());
    table.read(position, fields);
    const auto Y = bent(position);
    Eigen::Map<const Eigen::MatrixXf> U(fields.data(), static_cast<Eigen::Index>(table.rows()), C);
    const double ball = problem.sources[position].ball_radius, x = ball / problem.reference;
    const Eigen::MatrixXf directions = bentDirections(basis, x);
    std::vector<Eigen::Matrix3Xf> kept;
    const NearNodes& own = near[position];
    for (std::size_t j = 0; j < own.nodes.size(); ++j) {
      const Eigen::Index row = 3 * own.nodes[j];
      Eigen::Matrix3Xf u = -far.X.middleRows<3>(row) * Y;
      double size = 0.0;
      for (Eigen::Index k = 0; k < C - linear; ++k) {
        const int alpha = static_cast<int>(k + linear);
        const int degree = basis[alpha][0] + basis[alpha][1] + basis[alpha][2];
        u.col(k) += U.block<3, 1>(row, alpha) * static_cast<float>(std::pow(problem.reference, degree));
        size += static_cast<double>(u.col(k).norm()) * std::pow(x, degree);
      }
      if (static_cast<double>(own.window[j]) * size < kUnseen * ball) continue;
      nodes[position].push_back(own.nodes[j]);
      sizes[position].push_back(own.window[j] * (u * directions).colwise().norm().maxCoeff() /
                                static_cast<float>(ball));
      kept.emplace_back(own.window[j] * u);
    }
    for (Eigen::Index k = 0; k < C - linear; ++k)
      for (const Eigen::Matrix3Xf& u : kept)
        blocks[position].insert(blocks[position].end(), u.col(k).data(), u.col(k).data() + 3);
  });
  shareLists(
      of_ranks, [&](std::int32_t p) -> auto& { return nodes[static_cast<std::size_t>(p)]; });
  shareLists(
      of_ranks, [&](std::int32_t p) -> auto& { return blocks[static_cast<std::size_t>(p)]; });
  shareLists(
      of_ranks, [&](std::int32_t p) -> auto& { return sizes[static_cast<std::size_t>(p)]; });
  std::vector<float> all;
  data.near_offset.push_back(0);
  for (std::size_t p = 0; p < M; ++p) {
    data.near_offset.push_back(data.near_offset.back() + static_cast<std::int64_t>(nodes[p].size()));
    data.near_node.insert(data.near_node.end(), nodes[p].begin(), nodes[p].end());
    data.near_field.insert(data.near_field.end(), blocks[p].begin(), blocks[p].end());
    all.insert(all.end(), sizes[p].begin(), sizes[p].end());
  }
  return all;
}

}  // namespace palpate::solver
