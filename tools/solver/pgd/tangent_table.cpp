// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/tangent_table.h"

#include <algorithm>

namespace palpate::solver {

namespace {

TangentTable::View viewOf(const SparseMatrix& pattern, const double* values) {
  return {pattern.rows(),          pattern.cols(),          pattern.nonZeros(),
          pattern.outerIndexPtr(), pattern.innerIndexPtr(), values};
}

}  // namespace

TangentTable::TangentTable(const ParametricProblem& problem, double bytes, int workers) : problem_(problem) {
  work_.assign(static_cast<std::size_t>(workers), problem.stiffness());
  const double each =
      static_cast<double>(sizeof(double)) * static_cast<double>(problem.stiffness().nonZeros());
  if (bytes >= each)
    values_.resize(static_cast<std::size_t>(std::min(bytes / each, double(problem.positions()))));
}

TangentTable::View TangentTable::view(int worker, int s) const {
  const SparseMatrix& K0 = problem_.stiffness();
  if (constant_) return viewOf(K0, K0.valuePtr());
  if (s < kept()) return viewOf(K0, values_[static_cast<std::size_t>(s)].data());
  return viewOf(K0, work_[static_cast<std::size_t>(worker)].valuePtr());
}

TangentTable::View TangentTable::assemble(int worker, int s, const Eigen::VectorXd& u) {
  if (constant_) return view(worker, s);
  SparseMatrix& K = work_[static_cast<std::size_t>(worker)];
  problem_.tangent(u, K);
  if (s < kept())
    values_[static_cast<std::size_t>(s)] = Eigen::Map<Eigen::VectorXd>(K.valuePtr(), K.nonZeros());
  return view(worker, s);
}

}  // namespace palpate::solver
