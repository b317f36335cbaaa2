// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "tools/solver/fit/fit_problem.h"

namespace palpate::solver {

/// The work of fitFarField(): a sketch, then sweeps of a Y-step and an X-step each (far_field_fit.cpp).
class FarFieldFit {
 public:
  FarFieldFit(const FitProblem& problem, const FitOptions& options);
  FarField run();

 private:
  static constexpr std::size_t kChunk = 32;  // positions per read and product
  struct Worker {
    std::vector<float> fields;
    Eigen::MatrixXd row_rhs;  // 3 Ns x n, input of the X-step
    double error{0.0};        // weighted square of the remainder
    double energy{0.0};       // weighted square of the field
  };
  [[nodiscard]] std::size_t chunks() const { return (positions_ + kChunk - 1) / kChunk; }
  [[nodiscard]] Eigen::Map<Eigen::MatrixXf> readChunk(Worker& worker, std::size_t first,
                                                      std::size_t count) const;
  [[nodiscard]] Eigen::MatrixXf whitening(std::size_t position) const;
  [[nodiscard]] Eigen::MatrixXf whitenedY() const;
  void sketch();
  void sweep(bool last);
  struct Listed {
    Eigen::MatrixXf X, weighted_X, A;
    Eigen::VectorXf weight;  // change times area
  };
  [[nodiscard]] Listed listedRows(const Eigen::Ref<const Eigen::MatrixXf>& A,
                                  const FitWeights& weights) const;
  void solveY(const Eigen::Map<Eigen::MatrixXf>& A, std::size_t first, std::size_t count, Worker& worker);
  void feedX(const Eigen::Map<Eigen::MatrixXf>& A, std::size_t first, std::size_t count, Worker& worker);
  void solveX(const Eigen::MatrixXd& rhs);
  void orthonormalize(Eigen::MatrixXd X);
  void orderByEnergy();

  const FitProblem& problem_;
  FitOptions options_;
  Eigen::Index rows_, coefficients_, modes_;
  std::size_t positions_;
  Eigen::MatrixXd moment_factor_;  // C x C
  Eigen::VectorXd row_area_;       // 3 Ns, sums to 3
  FarField result_;
  std::vector<std::vector<std::pair<std::int32_t, float>>> positions_near_;  // node -> (position, weight - 1)
  std::vector<Worker> workers_;
};

}  // namespace palpate::solver
