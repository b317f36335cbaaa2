// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/dense_decompositions.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <stdexcept>
#include <string>

namespace palpate::solver {

namespace {

template <typename Decomposition>
void requireSuccess(const Decomposition& result, const char* what, const Eigen::MatrixXd& A) {
  if (result.info() == Eigen::Success) return;
  throw std::runtime_error(std::string(what) + " of a " + std::to_string(A.rows()) + " x " +
                           std::to_string(A.cols()) +
                           " matrix: " + (A.allFinite() ? "no convergence" : "it is not finite"));
}

}  // namespace

SingularValues singularValues(const Eigen::MatrixXd& A) {
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  requireSuccess(svd, "singular values", A);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

Eigenpairs eigenpairs(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
  requireSuccess(eigen, "eigenpairs", A);
  return {eigen.eigenvectors().rowwise().reverse(), eigen.eigenvalues().reverse()};
}

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A, Eigen::EigenvaluesOnly);
  requireSuccess(eigen, "eigenvalues", A);
  return eigen.eigenvalues().reverse();
}

}  // namespace palpate::solver
