// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/series/series.h"

#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>
#include <string>

#include "tools/solver/base/lanes.h"
#include "tools/solver/series/domain.h"
#include "tools/solver/series/series_kernel.h"

namespace palpate::solver {

namespace {

/// Neighbours in memory are neighbours in the mesh: each field is read once, not once per element.
std::vector<FeModel::Point> sorted(std::span<const FeModel::Point> of_the_mesh) {
  std::vector<FeModel::Point> points(of_the_mesh.begin(), of_the_mesh.end());
  std::sort(points.begin(), points.end(), [](const FeModel::Point& l, const FeModel::Point& r) {
    return *std::min_element(l.nodes.begin(), l.nodes.end()) <
           *std::min_element(r.nodes.begin(), r.nodes.end());
  });
  return points;
}

}  // namespace

struct SeriesSolver::State {
  State(const FeModel& fe, const Cholesky& factor, int order, SeriesKind driven_by)
      : model(fe),
        kind(driven_by),
        basis(order),
        answer_basis(answerOrder(order)),
        energy_basis(std::min(answerOrder(order) + 1, MonomialBasis::kMaxOrder)),
        product(basis, order),
        strain_product(answer_basis, order),
        energy_product(energy_basis, answerOrder(order)),
        points(sorted(fe.points())),
        solver(factor) {
    U.resize(static_cast<std::size_t>(model.nodeCount()) * coefficients() * 3);
    answer.resize(static_cast<std::size_t>(answer_basis.size()) * 3);
  }

  [[nodiscard]] std::size_t coefficients() const { return static_cast<std::size_t>(basis.size()); }
  [[nodiscard]] KernelInput input() const {
    return {points.data(), static_cast<int>(points.size()), basis.size(), U.data(), model.material().law};
  }
  Lanes* at(int node, int k) {
    return U.data() + (static_cast<std::size_t>(node) * coefficients() + static_cast<std::size_t>(k)) * 3;
  }

  void firstDegree();
  void prescribeDisplacement(int lane, const Mat3& C);
  void nextDegree(int degree);
  void correct(int k);
  void answerFromEnergy();
  void takeColumns(int first, int last, double sign);
  [[nodiscard]] Vec3 average(int lane, int k);

  const FeModel& model;
  SeriesKind kind;
  MonomialBasis basis;
  MonomialBasis answer_basis;
  MonomialBasis energy_basis;
  CauchyProduct product;         // of fields, for fields
  CauchyProduct strain_product;  // of fields, for strains to the degree of the force
  CauchyProduct energy_product;  // of strains, for the energy
  std::vector<FeModel::Point> points;
  Cholesky::Solver solver;
  std::span<const Patch> patches;
  LaneVector U;                                 // [node][k][3]
  LaneVector r;                                 // [node][k - first][3]
  LaneVector answer;                            // [k][3]
  Eigen::MatrixXd rhs;                          // dofs x (coefficients of the degree * kLanes)
  std::array<Mat3, kLanes> inverse_compliance;  // C_s^-1, N/m

  [[nodiscard]] const Patch& patch(int lane) const {
    return patches[std::min(static_cast<std::size_t>(lane),
                            patches.size() - 1)];  // idle lanes repeat the last one
  }
};

void SeriesSolver::State::takeColumns(int first, int last, double sign) {
  for (int node = 0; node < model.nodeCount(); ++node) {
    const int dof = model.dof(node);
    for (int k = first; k < last; ++k) {
      Lanes* u = at(node, k);
      for (int c = 0; c < 3; ++c)
        for (int lane = 0; lane < kLanes; ++lane)
          u[c][lane] = dof < 0 ? 0.0 : sign * rhs(dof + c, (k - first) * kLanes + lane);
    }
  }
}

Vec3 SeriesSolver::State::average(int lane, int k) {
  Vec3 d = Vec3::Zero();
  const Patch& p = patch(lane);
  for (std::size_t i = 0; i < p.nodes.size(); ++i)
    for (int c = 0; c < 3; ++c) d[c] += p.weights[i] * at(p.nodes[i], k)[c][lane];
  return d;
}

/// W_s = K0^-1 G_s, C_s = G_s^T W_s: the answer to unit forces, when driven by force.
void SeriesSolver::State::firstDegree() {
  rhs.setZero(model.dofCount(), 3 * kLanes);
  for (int lane = 0; lane < kLanes; ++lane)
    for (std::size_t i = 0; i < patch(lane).nodes.size(); ++i)
      for (int c = 0; c < 3; ++c)
        rhs(model.dof(patch(lane).nodes[i]) + c, c * kLanes + lane) = patch(lane).weights[i];
  solver.solveInPlace(rhs);
  takeColumns(0, 3, 1.0);
  for (int lane = 0; lane < kLanes; ++lane) {
    Mat3 C;
    for (int k = 0; k < 3; ++k) C.col(k) = average(lane, k);
    C = 0.5 * (C + C.transpose()).eval();
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) answer[static_cast<std::size_t>(3 * k + c)][lane] = C(c, k);
    if (kind == SeriesKind::kDisplacement) prescribeDisplacement(lane, C);
  }
}

/// f_{e_i} = C_s^-1 e_i, U_{e_i} = W_s f_{e_i}.
void SeriesSolver::State::prescribeDisplacement(int lane, const Mat3& C) {
  const Mat3 inverse = C.inverse();
  if (!inverse.allFinite())
    throw std::runtime_error("a contact patch cannot be moved: its compliance is singular");
  inverse_compliance[static_cast<std::size_t>(lane)] = inverse;
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c) answer[static_cast<std::size_t>(3 * k + c)][lane] = inverse(c, k);
  for (int node = 0; node < model.nodeCount(); ++node) {
    Mat3 W;
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) W(c, k) = at(node, k)[c][lane];
    const Mat3 u = W * inverse;
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) at(node, k)[c][lane] = u(c, k);
  }
}

/// v = -K0^-1 r: with f prescribed that is U, and d = G_s^T v.
void SeriesSolver::State::nextDegree(int degree) {
  const int first = basis.begin(degree);
  const int last = basis.begin(degree + 1);
  const int count = last - first;
  r.assign(static_cast<std::size_t>(model.nodeCount()) * static_cast<std::size_t>(count) * 3, Lanes{});
  assembleDegree(input(), product, first, last, r.data());
  rhs.resize(model.dofCount(), count * kLanes);
  for (int node = 0; node < model.nodeCount(); ++node) {
    const int dof = model.dof(node);
    if (dof < 0) continue;
    const Lanes* in = r.data() + static_cast<std::size_t>(node) * static_cast<std::size_t>(count) * 3;
    for (int k = 0; k < count; ++k)
      for (int c = 0; c < 3; ++c)
        for (int lane = 0; lane < kLanes; ++lane) rhs(dof + c, k * kLanes + lane) = in[3 * k + c][lane];
  }
  solver.solveInPlace(rhs);
  takeColumns(first, last, -1.0);
  for (int k = first; k < last; ++k) {
    if (kind == SeriesKind::kDisplacement) {
      correct(k);
      continue;
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      const Vec3 moved = average(lane, k);
      for (int c = 0; c < 3; ++c) answer[static_cast<std::size_t>(3 * k + c)][lane] = moved[c];
    }
  }
}

/// d prescribed: f = -C_s^-1 G_s^T v, U = v + W_s f = v - sum_i U_{e_i} (G_s^T v)_i.
void SeriesSolver::State::correct(int k) {
  Lanes d[3];
  for (int lane = 0; lane < kLanes; ++lane) {
    const Vec3 moved = average(lane, k);
    const Vec3 f = -inverse_compliance[static_cast<std::size_t>(lane)] * moved;
    for (int c = 0; c < 3; ++c) {
      d[c][lane] = moved[c];
      answer[static_cast<std::size_t>(3 * k + c)][lane] = f[c];
    }
  }
  for (int node = 0; node < model.nodeCount(); ++node) {
    Lanes* u = at(node, k);
    for (int i = 0; i < 3; ++i)
      for (int c = 0; c < 3; ++c) u[c] -= at(node, i)[c] * d[i];
  }
}

/// For p < |alpha| <= answerOrder(p): f_alpha,i = (alpha_i + 1) W_(alpha + e_i). With f prescribed the
/// potential W - f . d takes the place of W, and d is its negative gradient; in these degrees f . d has no
/// part.
void SeriesSolver::State::answerFromEnergy() {
  if (answer_basis.order() == basis.order()) return;
  const int first = energy_basis.begin(basis.order() + 2);
  LaneVector W(static_cast<std::size_t>(energy_basis.size() - first), Lanes{});
  const double sign = kind == SeriesKind::kDisplacement ? 1.0 : -1.0;
  energyCoefficients(input(), strain_product, energy_product, first, energy_basis.size(), W.data());
  for (int k = basis.size(); k < answer_basis.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      MultiIndex gamma = answer_basis[k];
      ++gamma[i];
      answer[static_cast<std::size_t>(3 * k) + i] =
          sign * static_cast<double>(gamma[i]) *
          W[static_cast<std::size_t>(energy_basis.find(gamma) - first)];
    }
  }
}

SeriesSolver::SeriesSolver(const FeModel& model, const Cholesky& factor, int order, SeriesKind kind)
    : state_(std::make_unique<State>(model, factor, order, kind)) {}
SeriesSolver::~SeriesSolver() = default;

void SeriesSolver::solve(std::span<const Patch> patches) {
  if (patches.empty() || patches.size() > kLanes)
    throw std::invalid_argument("series of " + std::to_string(patches.size()) +
                                " positions at once, expected 1 to " + std::to_string(kLanes));
  state_->patches = patches;
  state_->firstDegree();
  for (int degree = 2; degree <= state_->basis.order(); ++degree) state_->nextDegree(degree);
  state_->answerFromEnergy();
  for (std::size_t lane = 0; lane < patches.size(); ++lane)
    for (int k = 0; k < state_->answer_basis.size(); ++k)
      if (!answer(static_cast<int>(lane), k).allFinite())
        throw std::runtime_error("the series of a contact position is not finite");
}

const MonomialBasis& SeriesSolver::basis() const noexcept {
  return state_->basis;
}
const MonomialBasis& SeriesSolver::answerBasis() const noexcept {
  return state_->answer_basis;
}

Vec3 SeriesSolver::answer(int lane, int k) const {
  const Lanes* a = state_->answer.data() + static_cast<std::size_t>(3 * k);
  return {a[0][lane], a[1][lane], a[2][lane]};
}

Vec3 SeriesSolver::displacement(int lane, int k, int node) const {
  const Lanes* u = state_->at(node, k);
  return {u[0][lane], u[1][lane], u[2][lane]};
}

std::vector<double> SeriesSolver::domainRadii(const DomainCriteria& criteria) const {
  const bool by_force = state_->kind == SeriesKind::kForce;
  const int kept = by_force ? state_->basis.order() : state_->answer_basis.order();
  std::vector<double> radii(state_->patches.size());
  for (std::size_t lane = 0; lane < radii.size(); ++lane) {
    std::vector<Vec3> coefficients;
    for (int k = 0; k < state_->answer_basis.size(); ++k)
      coefficients.push_back(answer(static_cast<int>(lane), k));
    Mat3 C;
    for (int k = 0; k < 3; ++k) C.col(k) = coefficients[static_cast<std::size_t>(k)];
    const double cap = by_force ? criteria.cap / C.norm() : criteria.cap;
    radii[lane] = answerRadius(state_->answer_basis, coefficients, kept, cap, criteria.answer_error);
  }
  limitByDetF(state_->basis, state_->input(), criteria.min_det_f, radii);
  return radii;
}

}  // namespace palpate::solver
