// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/field_measures.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <variant>

#include "tools/solver/fem/quadratic_tetrahedra.h"

namespace palpate::solver {

double volumeChange(const FeModel& model, const Eigen::VectorXd& u) {
  double rest = 0.0, gain = 0.0;
  std::visit(
      [&](const auto& points) {
        for (const auto& point : points) {
          rest += point.weight;
          gain += point.weight * ((Mat3::Identity() + displacementGradient(point, u)).determinant() - 1.0);
        }
      },
      model.points());
  return gain / rest;
}

double normL2(const FeModel& model, const Eigen::VectorXd& u) {
  double squares = 0.0;
  for (int e = 0; e < model.elementCount(); ++e) {
    const std::span<const std::int32_t> nodes = model.elementNodes(e);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::size_t b = 0; b < nodes.size(); ++b)
        squares += model.volume(e) * productIntegral(nodes.size(), a, b) *
                   u.segment<3>(3 * nodes[a]).dot(u.segment<3>(3 * nodes[b]));
  }
  return std::sqrt(squares);
}

double relativeErrorL2(const FeModel& model, const Eigen::VectorXd& u, const Eigen::VectorXd& reference) {
  const double size = normL2(model, reference);
  if (!(size > 0.0)) throw std::invalid_argument("relative error: the reference field is zero");
  return normL2(model, u - reference) / size;
}

}  // namespace palpate::solver
