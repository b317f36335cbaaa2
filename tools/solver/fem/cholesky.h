// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "tools/solver/fem/fe_model.h"

namespace palpate::solver {

using SparseMatrix = Eigen::SparseMatrix<double>;  ///< column by column

/// L of L L^T, in blocks of columns with the same rows: columns first[s] .. first[s + 1] hold the rows
/// rows[row_begin[s] .. row_begin[s + 1]], their own before those below, column-major from value_begin[s] on.
struct Supernodes {
  std::span<const int> first, row_begin, value_begin, rows;
  const double* values;
};

/// Factorization of the tangent stiffness on the unknowns of an FeModel, by CHOLMOD (METIS ordering,
/// supernodal). The constructor does the symbolic analysis; factorize() may be called any number of times.
/// Several threads may call const functions and use Solvers of one factor at once.
class Cholesky {
 public:
  explicit Cholesky(const FeModel& model);
  /// Analyses and factorizes any symmetric matrix that stores both triangles.
  explicit Cholesky(const SparseMatrix& K);
  ~Cholesky();
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  /// Factorizes K_T(u). Falls back to L D L^T when K_T is not positive definite.
  /// @param u  3 N, m  @throw std::runtime_error naming the unknown where K_T is singular, std::bad_alloc
  void factorize(const Eigen::VectorXd& u);
  /// Factorizes a matrix with the pattern of the first.
  /// @throw std::invalid_argument for another pattern, std::runtime_error when K is singular
  void factorize(const SparseMatrix& K);
  [[nodiscard]] bool positiveDefinite() const noexcept { return !indefiniteAt().has_value(); }
  /// The unknown at which the matrix turned out not to be positive definite.
  [[nodiscard]] std::optional<int> indefiniteAt() const noexcept;
  /// @throw std::runtime_error naming the matrix and the unknown when it is not positive definite
  void requirePositiveDefinite(const std::string& matrix) const;
  /// Non-zeros of the factor.
  [[nodiscard]] double factorSize() const noexcept;
  /// The unknown that belongs to each row of the factor.
  [[nodiscard]] std::span<const int> order() const noexcept;
  /// For solvers of their own. @throw std::invalid_argument when K_T is not positive definite
  [[nodiscard]] Supernodes supernodes() const;
  /// Unknowns of K0 x = b. @param b  dofs x columns
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

  /// Solves for many right-hand sides. Its memory is its own, so several threads can share one factor.
  class Solver {
   public:
    explicit Solver(const Cholesky& factor);
    ~Solver();
    Solver(const Solver&) = delete;
    Solver& operator=(const Solver&) = delete;
    /// In place, dofs x columns column-major. @throw std::runtime_error when CHOLMOD fails
    void solveInPlace(Eigen::Ref<Eigen::MatrixXd> b);

   private:
    struct State;
    std::unique_ptr<State> state_;
  };

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::solver
