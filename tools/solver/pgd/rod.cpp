// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/pgd/rod.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace palpate::solver {

namespace {

void check(const RodData& data) {
  const auto positive = [](const char* name, double value) {
    if (!(value > 0.0) || !std::isfinite(value))
      throw std::invalid_argument(std::string("rod: ") + name + " is " + std::to_string(value) +
                                  "; expected a positive number");
  };
  positive("length", data.length);
  positive("area", data.area);
  positive("E", data.E);
  if (!std::isfinite(data.force)) throw std::invalid_argument("rod: force is not a finite number");
  if (data.elements < 1)
    throw std::invalid_argument("rod: elements is " + std::to_string(data.elements) +
                                "; expected at least 1");
}

/// Adds stiffness k between nodes e - 1 and e (node -1 is the clamp).
void addSpring(SparseMatrix& K, int e, double k) {
  K.coeffRef(e, e) += k;
  if (e == 0) return;
  K.coeffRef(e - 1, e - 1) += k;
  K.coeffRef(e, e - 1) -= k;
  K.coeffRef(e - 1, e) -= k;
}

}  // namespace

RodProblem::RodProblem(const RodData& data) : data_(data) {
  check(data);
  const int n = data.elements;
  loads_ = SparseMatrix(n, n);
  loads_.setIdentity();
  loads_ *= data.force;
  weights_ = Eigen::VectorXd::Constant(n, elementLength());
  weights_[n - 1] *= 0.5;
  stiffness_ = SparseMatrix(n, n);
  for (int e = 0; e < n; ++e) addSpring(stiffness_, e, data.E * data.area / elementLength());
  stiffness_.makeCompressed();
}

Eigen::VectorXd RodProblem::strain(const Eigen::VectorXd& u) const {
  Eigen::VectorXd H = u;
  H.tail(H.size() - 1) -= u.head(u.size() - 1);
  return H / elementLength();
}

Eigen::VectorXd RodProblem::nodalForce(const Eigen::VectorXd& axial) const {
  Eigen::VectorXd f = axial;
  f.head(f.size() - 1) -= axial.tail(axial.size() - 1);
  return f;
}

void RodProblem::tangent(const Eigen::VectorXd& u, SparseMatrix& K) const {
  const Eigen::VectorXd H = strain(u);
  std::fill(K.valuePtr(), K.valuePtr() + K.nonZeros(), 0.0);
  for (int e = 0; e < data_.elements; ++e) {
    const double l = 1.0 + H[e];
    addSpring(K, e, data_.E * data_.area / elementLength() * 0.5 * (3.0 * l * l - 1.0));
  }
}

Eigen::VectorXd RodProblem::internalForce(const Eigen::VectorXd& u) const {
  const Eigen::ArrayXd H = strain(u).array();
  // (l^3 - l) / 2 without cancellation at l = 1
  return nodalForce(data_.E * data_.area * (H * (1.0 + H) * (1.0 + 0.5 * H)).matrix());
}

double exactStretch(double K) {
  if (!(K >= 0.0)) throw std::invalid_argument("rod: K is " + std::to_string(K) + "; expected at least 0");
  const double below = 1.0 / 27.0 - K * K;
  if (below > 0.0) return 2.0 / std::sqrt(3.0) * std::cos(std::acos(std::sqrt(27.0) * K) / 3.0);
  const double b = std::cbrt(K + std::sqrt(-below));
  return b + 1.0 / (3.0 * b);
}

double exactTip(double K, double length) {
  return (exactStretch(K) - 1.0) * length;
}

Eigen::MatrixXd exactSolution(const RodProblem& rod) {
  const double strain = exactStretch(rod.data().loadNumber()) - 1.0;
  Eigen::MatrixXd u(rod.dofs(), rod.positions());
  for (int s = 0; s < rod.positions(); ++s)
    for (int x = 0; x < rod.dofs(); ++x) u(x, s) = strain * rod.elementLength() * (std::min(x, s) + 1);
  return u;
}

double RodSeries::force(double d) const {
  double sum = 0.0;
  for (Eigen::Index m = f.size() - 1; m >= 0; --m) sum = (sum + f[m]) * d;
  return sum;
}

double RodSeries::displacement(double wanted) const {
  double d = wanted / f[0];
  for (int i = 0; i < 100; ++i) {
    double slope = 0.0;
    for (Eigen::Index m = f.size() - 1; m >= 0; --m) slope = slope * d + static_cast<double>(m + 1) * f[m];
    const double step = (wanted - force(d)) / slope;
    d += step;
    if (std::abs(step) <= 1e-14 * std::abs(d)) return d;
  }
  throw std::runtime_error("rod: no displacement found for " + std::to_string(wanted) +
                           " N in a series of order " + std::to_string(f.size()));
}

RodSeries rodSeries(const RodProblem& rod, int node, int order) {
  if (node < 0 || node >= rod.dofs() || order < 1)
    throw std::invalid_argument("rod: series of order " + std::to_string(order) + " at node " +
                                std::to_string(node) + " of " + std::to_string(rod.dofs()));
  const double EA = rod.data().E * rod.data().area;
  const Cholesky K0(rod.stiffness());
  K0.requirePositiveDefinite("the stiffness of the rod");
  const Eigen::VectorXd W = K0.solve(Eigen::VectorXd::Unit(rod.dofs(), node));
  RodSeries series{Eigen::MatrixXd(rod.dofs(), order), Eigen::VectorXd(order)};
  Eigen::MatrixXd H(rod.dofs(), order), S(rod.dofs(), order);  // of each order; S times the area, N
  for (int m = 0; m < order; ++m) {
    Eigen::VectorXd quadratic = Eigen::VectorXd::Zero(rod.dofs());  // S'_m
    Eigen::VectorXd mixed = Eigen::VectorXd::Zero(rod.dofs());      // sum H_b S_c
    for (int b = 0; b < m; ++b) {
      quadratic += 0.5 * EA * H.col(b).cwiseProduct(H.col(m - 1 - b));
      mixed += H.col(b).cwiseProduct(S.col(m - 1 - b));
    }
    const Eigen::VectorXd v = -K0.solve(rod.nodalForce(quadratic + mixed));
    series.f[m] = ((m == 0 ? 1.0 : 0.0) - v[node]) / W[node];  // G^T U_m is 1 for m = 1, else 0
    series.U.col(m) = v + W * series.f[m];
    H.col(m) = rod.strain(series.U.col(m));
    S.col(m) = quadratic + EA * H.col(m);
  }
  return series;
}

}  // namespace palpate::solver
