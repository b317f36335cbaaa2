// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/series/series.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/solver/base/lanes.h"
#include "tools/solver/fem/ordered_solver.h"
#include "tools/solver/series/domain.h"
#include "tools/solver/series/node_order.h"
#include "tools/solver/series/series_kernel.h"
#include "tools/solver/series/spring_energy.h"

namespace palpate::solver {

struct SeriesSolver::State {
  State(const FeModel& fe, const Cholesky& factor, const SeriesOrders& orders, SeriesKind driven_by)
      : model(fe),
        kind(driven_by),
        basis(orders.fields),
        answer_basis(orders.answer),
        energy_basis(orders.answer + 1),
        product(basis, orders.fields),
        energy_fields((orders.answer + 1) / 2),
        factor_product(answer_basis, energy_fields.order()),
        energy_rows(CauchyProduct(energy_basis, orders.answer), firstEnergy()),
        order_of_nodes(fe, factor),
        points(order_of_nodes.sorted(fe.points())),
        det_points(order_of_nodes.sorted(fe.detPoints())),
        length(pointLength(points)),
        solver(factor) {
    U.resize(static_cast<std::size_t>(model.nodeCount()) * coefficients() * 3);
    V.resize(U.size());
    answer.resize(static_cast<std::size_t>(answer_basis.size()) * 3);
  }

  [[nodiscard]] std::size_t coefficients() const { return static_cast<std::size_t>(basis.size()); }
  /// The first coefficient of the energy that the force takes from it.
  [[nodiscard]] int firstEnergy() const {
    return energy_basis.begin(std::min(basis.order() + 2, energy_basis.order() + 1));
  }
  [[nodiscard]] KernelInput input(const FeModel::Points& of) const {
    return {&of, basis.size(), U.data(), V.data(), length};
  }
  /// Of a coefficient in U and V.
  [[nodiscard]] std::size_t at(std::size_t place, int k) const {
    return (place * coefficients() + static_cast<std::size_t>(k)) * 3;
  }
  void firstDegree();
  void nextDegree(int degree);
  void fillSides(std::size_t count);
  void takeFields(int first, int last, const Lanes* mix);
  void store(int lane, int k, const Vec3& value);
  const Mat3& inverseCompliance(int lane, const Mat3& C);
  void answerFromEnergy();
  [[nodiscard]] Vec3 average(int lane, int j) const;
  [[nodiscard]] std::vector<Vec3> patchFields(int lane) const;

  const FeModel& model;
  SeriesKind kind;
  MonomialBasis basis;
  MonomialBasis answer_basis;
  MonomialBasis energy_basis;
  CauchyProduct product;         // of fields, for fields
  MonomialBasis energy_fields;   // fields of degree n make the energy right to degree 2n + 1
  CauchyProduct factor_product;  // of those, for what the energy is made of, to the degree of the force
  CauchyRows energy_rows;        // of those, for the energy
  NodeOrder order_of_nodes;
  FeModel::Points points, det_points;
  double length;  // unit of V: m, or N when driven by force
  OrderedSolver solver;
  std::span<const Patch> patches;
  LaneVector U;                                 // [place][k][3]; zero at clamped nodes
  FloatLaneVector V;                            // U_alpha length^|alpha|, as U
  LaneVector r;                                 // [place][k - first][3]
  LaneVector answer;                            // [k][3]
  LaneVector sides;                             // [row of the factor][k - first]
  std::array<Mat3, kLanes> inverse_compliance;  // C_s^-1, N/m

  [[nodiscard]] const Patch& patch(int lane) const {
    return patches[std::min(static_cast<std::size_t>(lane),
                            patches.size() - 1)];  // idle lanes repeat the last one
  }
};

/// The patch's average of the solution, coefficient j of those that `sides` holds.
Vec3 SeriesSolver::State::average(int lane, int j) const {
  const std::size_t count = sides.size() / order_of_nodes.rows.size();
  Vec3 d = Vec3::Zero();
  const Patch& p = patch(lane);
  for (std::size_t i = 0; i < p.nodes.size(); ++i)
    for (int c = 0; c < 3; ++c)
      d[c] += p.weights[i] *
              sides[order_of_nodes.rowOf(p.nodes[i], c) * count + static_cast<std::size_t>(j)][lane];
  return d;
}

void SeriesSolver::State::store(int lane, int k, const Vec3& value) {
  for (int c = 0; c < 3; ++c) answer[static_cast<std::size_t>(3 * k + c)][lane] = value[c];
}

/// U_k from the solution, first <= k < last of one degree. @param mix  [k - first][3], see fieldsFromRows
void SeriesSolver::State::takeFields(int first, int last, const Lanes* mix) {
  const MultiIndex& alpha = basis[first];
  const double unit = std::pow(length, alpha[0] + alpha[1] + alpha[2]);
  fieldsFromRows(order_of_nodes.rows, {sides.data(), first, last, mix, unit}, basis.size(), U.data(),
                 V.data());
}

/// W_s = K0^-1 G_s, C_s = G_s^T W_s: the answer to unit forces, when driven by force. Driven by displacement,
/// f_{e_i} = C_s^-1 e_i, U_{e_i} = W_s f_{e_i}.
void SeriesSolver::State::firstDegree() {
  sides.assign(order_of_nodes.rows.size() * 3, Lanes{});
  for (int lane = 0; lane < kLanes; ++lane)
    for (std::size_t i = 0; i < patch(lane).nodes.size(); ++i)
      for (int c = 0; c < 3; ++c)
        sides[order_of_nodes.rowOf(patch(lane).nodes[i], c) * 3 + static_cast<std::size_t>(c)][lane] =
            patch(lane).weights[i];
  solver.solve(sides, 3);
  std::array<Lanes, 9> mix{};  // of the columns of W_s, [k][i]
  double softest = 0.0;
  for (int lane = 0; lane < kLanes; ++lane) {
    Mat3 C;
    for (int k = 0; k < 3; ++k) C.col(k) = average(lane, k);
    C = 0.5 * (C + C.transpose()).eval();
    softest = std::max(softest, C.norm());
    Mat3 M = Mat3::Identity();
    if (kind == SeriesKind::kDisplacement) C = M = inverseCompliance(lane, C);
    for (int k = 0; k < 3; ++k) {
      store(lane, k, C.col(k));
      for (int i = 0; i < 3; ++i) mix[static_cast<std::size_t>(3 * k + i)][lane] = M(i, k);
    }
  }
  if (kind == SeriesKind::kForce) length = std::exp2(std::round(std::log2(pointLength(points) / softest)));
  takeFields(0, 3, mix.data());
}

/// C_s^-1, N/m.
const Mat3& SeriesSolver::State::inverseCompliance(int lane, const Mat3& C) {
  const Eigen::LLT<Mat3> factor(C);
  if (factor.info() != Eigen::Success)
    throw std::runtime_error("the compliance of the contact patch at volume node " +
                             std::to_string(patch(lane).nodes.front()) + " is not positive definite");
  Mat3& inverse = inverse_compliance[static_cast<std::size_t>(lane)];
  inverse = factor.solve(Mat3::Identity());
  return inverse;
}

/// `sides` from r.
void SeriesSolver::State::fillSides(std::size_t count) {
  sides.resize(order_of_nodes.rows.size() * count);
  auto side = sides.begin();
  for (const NodeRow& row : order_of_nodes.rows)
    for (std::size_t j = 0; j < count; ++j) *side++ = r[(row.place * count + j) * 3 + row.c];
}

/// v = -K0^-1 r: with f prescribed that is U, and d = G_s^T v. With d prescribed f = -C_s^-1 G_s^T v,
/// U = v + W_s f = v - sum_i U_{e_i} (G_s^T v)_i.
void SeriesSolver::State::nextDegree(int degree) {
  const int first = basis.begin(degree);
  const int last = basis.begin(degree + 1), count = last - first;
  r.assign(static_cast<std::size_t>(model.nodeCount()) * static_cast<std::size_t>(count) * 3, Lanes{});
  assembleDegree(input(points), product, first, last, r.data());
  fillSides(static_cast<std::size_t>(count));
  solver.solve(sides, count);
  std::array<Lanes, 3 * MonomialBasis::kMaxCoefficients> mix;  // [k - first][i]: of U_{e_i}
  for (int lane = 0; lane < kLanes; ++lane)
    for (int j = 0; j < count; ++j) {
      const Vec3 moved = -average(lane, j);
      const bool by_force = kind == SeriesKind::kForce;
      store(lane, first + j,
            by_force ? moved : Vec3(-inverse_compliance[static_cast<std::size_t>(lane)] * moved));
      for (int i = 0; i < 3; ++i) mix[static_cast<std::size_t>(3 * j + i)][lane] = by_force ? 0.0 : -moved[i];
    }
  takeFields(first, last, mix.data());
}

/// For p < |alpha| <= the degree of the answer: f_alpha,i = (alpha_i + 1) W_(alpha + e_i). With f prescribed the
/// potential W - f . d takes the place of W, and d is its negative gradient; in these degrees f . d has no
/// part.
void SeriesSolver::State::answerFromEnergy() {
  if (answer_basis.order() == basis.order()) return;
  const int first = firstEnergy();
  LaneVector W(static_cast<std::size_t>(energy_basis.size() - first), Lanes{});
  const double sign = kind == SeriesKind::kDisplacement ? 1.0 : -1.0;
  energyCoefficients(input(points), energy_fields.size(), factor_product, energy_rows,
                     static_cast<int>(W.size()), W.data());
  addSpringEnergies(model, order_of_nodes, energy_fields, input(points), energy_rows, W.data());
  for (int k = basis.size(); k < answer_basis.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      MultiIndex gamma = answer_basis[k];
      ++gamma[i];
      const double unit = std::pow(length, -(gamma[0] + gamma[1] + gamma[2]));
      answer[static_cast<std::size_t>(3 * k) + i] =
          sign * unit * static_cast<double>(gamma[i]) *
          W[static_cast<std::size_t>(energy_basis.find(gamma) - first)];
    }
  }
}

SeriesSolver::SeriesSolver(const FeModel& model, const Cholesky& factor, const SeriesOrders& orders,
                           SeriesKind kind)
    : state_(std::make_unique<State>(model, factor, orders.checked(), kind)) {}
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

/// U_alpha at the nodes of the patch, [node][k]: nowhere do fields move more.
std::vector<Vec3> SeriesSolver::State::patchFields(int lane) const {
  std::vector<Vec3> fields;
  for (const std::int32_t node : patch(lane).nodes)
    for (int k = 0; k < basis.size(); ++k) {
      const Lanes* u = U.data() + at(order_of_nodes.placeOf(node), k);
      fields.emplace_back(u[0][lane], u[1][lane], u[2][lane]);
    }
  return fields;
}

Vec3 SeriesSolver::displacement(int lane, int k, int node) const {
  const Lanes* u = state_->U.data() + state_->at(state_->order_of_nodes.placeOf(node), k);
  return {u[0][lane], u[1][lane], u[2][lane]};
}

void SeriesSolver::copyDisplacements(std::span<const std::int32_t> nodes, std::span<float> fields) const {
  constexpr std::size_t kTogether = 16;  // nodes, of which all coefficients stay in the cache
  const State& s = *state_;
  const std::size_t rows = 3 * nodes.size();
  for (std::size_t begin = 0; begin < nodes.size(); begin += kTogether)
    for (std::size_t k = 0; k < s.coefficients(); ++k)
      for (std::size_t lane = 0; lane < s.patches.size(); ++lane) {
        float* out = fields.data() + (lane * s.coefficients() + k) * rows + 3 * begin;
        for (std::size_t i = begin; i < std::min(begin + kTogether, nodes.size()); ++i)
          for (std::size_t c = 0; c < 3; ++c)
            *out++ = static_cast<float>(s.U[s.at(s.order_of_nodes.placeOf(nodes[i]), static_cast<int>(k)) + c]
                                           [static_cast<int>(lane)]);
      }
}

std::vector<SeriesRadii> SeriesSolver::domainRadii(const DomainCriteria& criteria) const {
  const bool by_force = state_->kind == SeriesKind::kForce;
  const int kept = by_force ? state_->basis.order() : state_->answer_basis.order();
  std::vector<double> domain(state_->patches.size());
  std::vector<SeriesRadii> radii(domain.size());
  for (std::size_t lane = 0; lane < domain.size(); ++lane) {
    std::vector<Vec3> coefficients;
    for (int k = 0; k < state_->answer_basis.size(); ++k)
      coefficients.push_back(answer(static_cast<int>(lane), k));
    Mat3 C;
    for (int k = 0; k < 3; ++k) C.col(k) = coefficients[static_cast<std::size_t>(k)];
    const double cap = by_force ? criteria.cap / C.norm() : criteria.cap;
    const auto radius = [&](double error) {
      return answerRadius(state_->answer_basis, coefficients, kept, cap, error);
    };
    domain[lane] = radius(criteria.answer_error);
    if (by_force) continue;
    radii[lane].series = radius(std::max(criteria.answer_error, criteria.series_error));
    domain[lane] = fieldRadius(state_->basis, state_->patchFields(static_cast<int>(lane)),
                               state_->answer_basis, coefficients, domain[lane], criteria.field_error);
  }
  limitByDetF(state_->basis, state_->input(state_->det_points), criteria.min_det_f, domain);
  for (std::size_t lane = 0; lane < domain.size(); ++lane)
    radii[lane] = {by_force ? domain[lane] : std::max(radii[lane].series, domain[lane]), domain[lane]};
  return radii;
}

}  // namespace palpate::solver
