// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/dense_decompositions.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace palpate::solver {

SingularValues singularValues(const Eigen::MatrixXd& A) {
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

Eigenpairs eigenpairs(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
  return {eigen.eigenvectors().rowwise().reverse(), eigen.eigenvalues().reverse()};
}

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues().reverse();
}

}  // namespace palpate::solver
