// SPDX-License-Identifier: Apache-2.0
// The two steps of a sweep: least squares in Y for given X, and in X for given Y.       docs/design.md, Parts
#include "tools/solver/fit/far_field_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "tools/solver/base/parallel.h"

namespace palpate::solver {

using Eigen::MatrixXd;
using Eigen::MatrixXf;

/// Y-step: n x n normal equations per position: those of the areas, corrected at nodes with another weight.
void FarFieldFit::solveY(const Eigen::Map<MatrixXf>& A, std::size_t first, std::size_t count,
                         Worker& worker) {
  const MatrixXf weighted = row_area_.cast<float>().asDiagonal() * result_.X;
  const MatrixXf rhs = weighted.transpose() * A;
  MatrixXd gram = (weighted.transpose() * result_.X).cast<double>();
  gram.diagonal().array() += 1e-6;             // X is orthonormal; for modes that only free entries see
  const Eigen::LLT<MatrixXd> unchanged(gram);  // of the positions whose weights are the areas
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Index column = static_cast<Eigen::Index>(i) * coefficients_;
    const Listed listed = listedRows(A.middleCols(column, coefficients_), problem_.weights[first + i]);
    const MatrixXf near_rhs = listed.weighted_X.transpose() * listed.A;
    const MatrixXd b = (rhs.middleCols(column, coefficients_) + near_rhs).cast<double>();
    MatrixXd Y;
    if (listed.weight.size() == 0) {
      Y = unchanged.solve(b);
    } else {
      const MatrixXf near_gram = listed.X.transpose() * listed.weighted_X;
      Y = (gram + near_gram.cast<double>()).llt().solve(b);
    }
    result_.Y.middleCols(static_cast<Eigen::Index>(first) * coefficients_ + column, coefficients_) =
        Y.cast<float>();
    // |A - X Y|^2 in the weights, from the normal equations: |A|^2 - Y : b.
    const MatrixXf W = whitening(first + i);
    const MatrixXf AW =
        row_area_.cast<float>().cwiseSqrt().asDiagonal() * (A.middleCols(column, coefficients_) * W);
    const MatrixXf AnW = listed.A * W;
    const MatrixXf changed = listed.weight.asDiagonal() * AnW;
    const double energy = AW.cast<double>().squaredNorm() + changed.cwiseProduct(AnW).cast<double>().sum();
    const MatrixXd Wd = W.cast<double>();
    worker.energy += energy;
    worker.error += std::max(0.0, energy - (Y * Wd).cwiseProduct(b * Wd).sum());
  }
}

/// The rows of the nodes whose weight is not their area.
FarFieldFit::Listed FarFieldFit::listedRows(const Eigen::Ref<const MatrixXf>& A,
                                            const FitWeights& weights) const {
  const auto K = static_cast<Eigen::Index>(weights.nodes.size());
  Listed listed{MatrixXf(3 * K, modes_), MatrixXf(), MatrixXf(3 * K, coefficients_), Eigen::VectorXf(3 * K)};
  for (Eigen::Index j = 0; j < K; ++j) {
    const Eigen::Index row = 3 * weights.nodes[static_cast<std::size_t>(j)];
    listed.X.middleRows<3>(3 * j) = result_.X.middleRows<3>(row);
    listed.A.middleRows<3>(3 * j) = A.middleRows<3>(row);
    listed.weight.segment<3>(3 * j).setConstant(weights.change[static_cast<std::size_t>(j)] *
                                                static_cast<float>(row_area_[row]));
  }
  listed.weighted_X = listed.weight.asDiagonal() * listed.X;
  return listed;
}

/// Right-hand side of the X-step: A W W^T Y^T, corrected at nodes with another weight.
void FarFieldFit::feedX(const Eigen::Map<MatrixXf>& A, std::size_t first, std::size_t count, Worker& worker) {
  MatrixXf V(A.cols(), modes_);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Index column = static_cast<Eigen::Index>(i) * coefficients_;
    const MatrixXf W = whitening(first + i);
    const auto Y =
        result_.Y.middleCols(static_cast<Eigen::Index>(first) * coefficients_ + column, coefficients_);
    V.middleRows(column, coefficients_) = W * (W.transpose() * Y.transpose());
    const FitWeights& weights = problem_.weights[first + i];
    MatrixXf An(static_cast<Eigen::Index>(3 * weights.nodes.size()), coefficients_);
    for (std::size_t j = 0; j < weights.nodes.size(); ++j)
      An.middleRows<3>(static_cast<Eigen::Index>(3 * j)) =
          weights.change[j] * A.block(3 * weights.nodes[j], column, 3, coefficients_);
    const MatrixXf near_part = An * V.middleRows(column, coefficients_);
    for (std::size_t j = 0; j < weights.nodes.size(); ++j)
      worker.row_rhs.middleRows<3>(3 * weights.nodes[j]) +=
          near_part.middleRows<3>(static_cast<Eigen::Index>(3 * j)).cast<double>();
  }
  const MatrixXf product = A * V;
  worker.row_rhs += product.cast<double>();
}

/// X-step: one n x n system per node: the sum over all positions, corrected where the node's weight is not
/// its area.
void FarFieldFit::solveX(const MatrixXd& rhs) {
  const MatrixXf Z = whitenedY();
  const MatrixXf all_f = Z * Z.transpose();
  MatrixXd all = all_f.cast<double>();
  all.diagonal().array() += 1e-9 * all.trace() / static_cast<double>(modes_);
  const Eigen::LLT<MatrixXd> unchanged(all);  // of the nodes whose weight is their area for every position
  MatrixXd X(rows_, modes_);
  parallelFor(options_.workers, problem_.areas.size(), [&](int, std::size_t node) {
    const auto& near = positions_near_[node];
    const auto row = static_cast<Eigen::Index>(3 * node);
    if (near.empty()) {
      X.middleRows<3>(row) = unchanged.solve(rhs.middleRows<3>(row).transpose()).transpose();
      return;
    }
    MatrixXf Zn(modes_, static_cast<Eigen::Index>(near.size()) * coefficients_);
    MatrixXf weighted(Zn.rows(), Zn.cols());
    for (std::size_t j = 0; j < near.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j) * coefficients_;
      Zn.middleCols(column, coefficients_) = Z.middleCols(near[j].first * coefficients_, coefficients_);
      weighted.middleCols(column, coefficients_) = near[j].second * Zn.middleCols(column, coefficients_);
    }
    const MatrixXf change = weighted * Zn.transpose();
    const MatrixXd normal = all + change.cast<double>();
    X.middleRows<3>(row) = normal.llt().solve(rhs.middleRows<3>(row).transpose()).transpose();
  });
  orthonormalize(X);
}

}  // namespace palpate::solver
