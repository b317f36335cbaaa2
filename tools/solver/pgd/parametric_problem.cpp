// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/parametric_problem.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace palpate::solver {

namespace {

std::size_t indexOf(Eigen::Index i) {
  return static_cast<std::size_t>(i);
}

/// Zeros wherever two free nodes share an element.
SparseMatrix patternOf(const FeModel& model) {
  std::vector<std::vector<int>> neighbours(indexOf(model.nodeCount()));
  for (int e = 0; e < model.elementCount(); ++e)
    for (const int a : model.elementNodes(e))
      for (const int b : model.elementNodes(e))
        if (model.isFree(a) && model.isFree(b)) neighbours[indexOf(a)].push_back(model.dof(b));
  SparseMatrix K(model.dofCount(), model.dofCount());
  std::vector<int> counts(indexOf(model.dofCount()));
  for (int node = 0; node < model.nodeCount(); ++node) {
    auto& list = neighbours[indexOf(node)];
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    if (model.isFree(node))
      for (int c = 0; c < 3; ++c) counts[indexOf(model.dof(node) + c)] = static_cast<int>(3 * list.size());
  }
  K.reserve(counts);
  for (int node = 0; node < model.nodeCount(); ++node)
    for (const int first : neighbours[indexOf(node)])
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) K.insert(first + r, model.dof(node) + c) = 0.0;
  K.makeCompressed();
  return K;
}

std::int32_t placeOf(const SparseMatrix& K, int row, int column) {
  const int* const first = K.innerIndexPtr() + K.outerIndexPtr()[column];
  const int* const last = K.innerIndexPtr() + K.outerIndexPtr()[column + 1];
  return static_cast<std::int32_t>(std::lower_bound(first, last, row) - K.innerIndexPtr());
}

}  // namespace

BodyProblem::BodyProblem(const FeModel& model, SparseMatrix loads, Eigen::VectorXd weights)
    : model_(model), loads_(std::move(loads)), weights_(std::move(weights)), stiffness_(patternOf(model)) {
  if (loads_.rows() != model.dofCount() || loads_.cols() != weights_.size())
    throw std::invalid_argument("loads are " + std::to_string(loads_.rows()) + " x " +
                                std::to_string(loads_.cols()) + ", weights " +
                                std::to_string(weights_.size()) + "; expected " +
                                std::to_string(model.dofCount()) + " rows and as many columns as weights");
  places_.reserve(indexOf(model.elementCount()) * 9 * (model.isQuadratic() ? 100 : 16));
  for (int e = 0; e < model.elementCount(); ++e) {
    const std::span<const std::int32_t> nodes = model.elementNodes(e);
    for (std::size_t b = 0; b < 3 * nodes.size(); ++b)
      for (std::size_t a = 0; a < 3 * nodes.size(); ++a) {
        const int row = model.dof(nodes[a / 3]), column = model.dof(nodes[b / 3]);
        places_.push_back(row < 0 || column < 0 ? -1
                                                : placeOf(stiffness_, row + static_cast<int>(a % 3),
                                                          column + static_cast<int>(b % 3)));
      }
  }
  tangent(Eigen::VectorXd::Zero(dofs()), stiffness_);
}

Eigen::VectorXd BodyProblem::toNodes(const Eigen::VectorXd& unknowns) const {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * model_.nodeCount());
  for (int node = 0; node < model_.nodeCount(); ++node)
    if (model_.isFree(node)) u.segment<3>(3 * node) = unknowns.segment<3>(model_.dof(node));
  return u;
}

void BodyProblem::tangent(const Eigen::VectorXd& u, SparseMatrix& K) const {
  const Eigen::VectorXd nodal = toNodes(u);
  double* const values = K.valuePtr();
  std::fill(values, values + K.nonZeros(), 0.0);
  const std::int32_t* place = places_.data();
  for (int e = 0; e < model_.elementCount(); ++e) {
    const FeModel::ElementMatrix element = model_.elementTangent(e, nodal);
    for (Eigen::Index i = 0; i < element.size(); ++i, ++place)
      if (*place >= 0) values[*place] += element.data()[i];
  }
}

Eigen::VectorXd BodyProblem::internalForce(const Eigen::VectorXd& u) const {
  const Eigen::VectorXd nodal = model_.internalForce(toNodes(u));
  Eigen::VectorXd f(dofs());
  for (int node = 0; node < model_.nodeCount(); ++node)
    if (model_.isFree(node)) f.segment<3>(model_.dof(node)) = nodal.segment<3>(3 * node);
  return f;
}

SparseMatrix patchLoads(const FeModel& model, std::span<const Patch> patches, std::span<const Vec3> forces) {
  std::vector<Eigen::Triplet<double>> entries;
  int column = 0;
  for (const Patch& patch : patches) {
    for (const Vec3& f : forces) {
      for (std::size_t i = 0; i < patch.nodes.size(); ++i)
        for (int c = 0; c < 3; ++c)
          if (f[c] != 0.0)
            entries.emplace_back(model.dof(patch.nodes[i]) + c, column, patch.weights[i] * f[c]);
      ++column;
    }
  }
  SparseMatrix loads(model.dofCount(), column);
  loads.setFromTriplets(entries.begin(), entries.end());
  return loads;
}

}  // namespace palpate::solver
