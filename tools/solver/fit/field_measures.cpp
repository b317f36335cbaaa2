// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/field_measures.h"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

namespace palpate::solver {

double volumeChange(const FeModel& model, const Eigen::VectorXd& u) {
  double rest = 0.0, gain = 0.0;
  for (const FeModel::Point& point : model.points()) {
    rest += point.weight;
    gain += point.weight * ((Mat3::Identity() + displacementGradient(point, u)).determinant() - 1.0);
  }
  return gain / rest;
}

double normL2(const FeModel& model, const Eigen::VectorXd& u) {
  double squares = 0.0;
  for (int e = 0; e < model.elementCount(); ++e) {
    Vec3 sum = Vec3::Zero();
    double own = 0.0;
    for (const std::int32_t node : model.tetrahedra()[static_cast<std::size_t>(e)]) {
      sum += u.segment<3>(3 * node);
      own += u.segment<3>(3 * node).squaredNorm();
    }
    squares += model.volume(e) / 20.0 * (sum.squaredNorm() + own);  // int N_a N_b = V (1 + delta_ab) / 20
  }
  return std::sqrt(squares);
}

double relativeErrorL2(const FeModel& model, const Eigen::VectorXd& u, const Eigen::VectorXd& reference) {
  const double size = normL2(model, reference);
  if (!(size > 0.0)) throw std::invalid_argument("relative error: the reference field is zero");
  return normL2(model, u - reference) / size;
}

}  // namespace palpate::solver
