// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/edge_surplus.h"

#include <algorithm>
#include <cmath>

#include "tools/solver/series/domain.h"

namespace palpate::solver {

namespace {

constexpr double kTooHigh =
    2.75;  // what an edge misses in its worst direction over what touches do: docs/decisions/domain.md
constexpr double kSlowest = 0.8;  // of the terms of one degree over those of the last

ModelView surfaceOf(const modelfile::ModelData& data) {
  ModelView view;
  view.surface_positions = data.surface_positions;
  view.surface_triangles = data.surface_triangles;
  view.surface_mesh_tag = data.surface_mesh_tag;
  view.position_of_node = data.position_of_node;
  view.contact_node = data.contact_node;
  view.contact_accessible = data.contact_accessible;
  view.contact_triangles = data.contact_triangles;
  return view;
}

/// Terms along one direction, by degree.
class DegreeSums {
 public:
  DegreeSums(const MonomialBasis& basis, const std::vector<Vec3>& coefficients, const Vec3& direction)
      : order_(static_cast<std::size_t>(basis.order())) {
    std::array<double, MonomialBasis::kMaxCoefficients> monomial{};
    basis.evaluate(direction, monomial);
    for (std::size_t k = 0; k < coefficients.size(); ++k) {
      const MultiIndex& alpha = basis[static_cast<int>(k)];
      terms_[static_cast<std::size_t>(alpha[0] + alpha[1] + alpha[2])] += monomial[k] * coefficients[k];
    }
  }
  [[nodiscard]] Vec3 at(double r) const {
    Vec3 sum = Vec3::Zero();
    double power = 1.0;
    for (std::size_t degree = 1; degree <= order_; ++degree) sum += (power *= r) * terms_[degree];
    return sum;
  }
  /// Size of what comes beyond the last degree, when it goes on as the last two do.
  [[nodiscard]] double tail(double r) const {
    const double last = terms_[order_].norm(), previous = terms_[order_ - 1].norm();
    if (last == 0.0) return 0.0;
    const double next = order_ > 2 && previous > 0.0 ? std::min(kSlowest, r * last / previous) : kSlowest;
    return last * std::pow(r, static_cast<double>(order_)) * next / (1.0 - next);
  }

 private:
  std::size_t order_;
  std::array<Vec3, kMostOrder + 1> terms_ = [] {
    std::array<Vec3, kMostOrder + 1> zero;
    zero.fill(Vec3::Zero());
    return zero;
  }();
};

}  // namespace

EdgeFields::EdgeFields(const SolverSetup& setup, const ContactPatches& patches, int order,
                       const modelfile::ModelData& data)
    : setup_(setup),
      patches_(patches),
      data_(data),
      view_(surfaceOf(data)),
      surface_(view_),
      mixing_(view_, surface_),
      places_(view_.surface_positions, view_.contact_triangles, view_.position_of_node),
      basis_(order),
      rows_(static_cast<std::size_t>(basis_.size()) - kLinearCoefficients),
      position_rows_(static_cast<std::size_t>(MonomialBasis::size(data.attributes.order)) -
                     kLinearCoefficients),
      modes_(data.modes_X.size() / data.surface_positions.size()),
      X_(data.modes_X.data(), Eigen::Index(data.surface_positions.size()), Eigen::Index(modes_)) {}

std::array<std::size_t, 2> EdgeFields::ends(std::size_t edge) const {
  const ContactPoint& s = middle(edge);
  std::array<std::size_t, 2> positions{};
  for (std::size_t k = 0, end = 0; k < 3; ++k)
    if (s.barycentric[k] != 0.0)
      positions[end++] =
          index(view_.position_of_node[index(view_.contact_triangles[3 * index(s.triangle) + k])]);
  return positions;
}

bool EdgeFields::isLong(std::size_t edge) const {
  const ContactPoint& s = middle(edge);
  const std::array<Vec3, 3> X = surface_.corners(s.triangle);
  for (std::size_t k = 0; k < 3; ++k)
    if (s.barycentric[k] == 0.0)
      return (X[(k + 1) % 3] - X[(k + 2) % 3]).norm() > kShortestEdge * setup_.patch_radius;
  return false;
}

Patch EdgeFields::patch(std::size_t edge, PatchNodes& room) const {
  patches_.at(middle(edge), false, room);
  return patchOf(setup_.surface, room);
}

/// u -= the model's mixture. @param u  [3 near nodes][rows]
void EdgeFields::subtractMixture(const Stencil& stencil, const NearNodes& near, Eigen::MatrixXf& u) const {
  Eigen::MatrixXf Y = Eigen::MatrixXf::Zero(Eigen::Index(modes_), Eigen::Index(rows_));
  for (std::size_t b = 0; b < stencil.count; ++b) {
    const std::size_t position = index(stencil.position[b]);
    const auto weight = static_cast<float>(stencil.weight[b]);
    Y += weight * Eigen::Map<const Eigen::MatrixXf>(data_.modes_Y.data() + position * position_rows_ * modes_,
                                                    Y.rows(), Y.cols());
    const std::size_t first = index(data_.near_offset[position]),
                      K = index(data_.near_offset[position + 1]) - first;
    const float* const field = data_.near_field.data() + 3 * position_rows_ * first;
    std::size_t j = 0;
    for (std::size_t i = 0; i < near.nodes.size(); ++i) {  // both ascending
      while (j < K && data_.near_node[first + j] < near.nodes[i]) ++j;
      if (j == K) break;
      if (data_.near_node[first + j] != near.nodes[i]) continue;
      for (std::size_t k = 0; k < rows_; ++k)
        u.block<3, 1>(Eigen::Index(3 * i), Eigen::Index(k)) -=
            weight * Eigen::Map<const Eigen::Vector3f>(field + 3 * (k * K + j));
    }
  }
  for (std::size_t i = 0; i < near.nodes.size(); ++i)
    u.middleRows<3>(Eigen::Index(3 * i)) -= X_.middleRows<3>(3 * near.nodes[i]) * Y;
}

Surplus EdgeFields::surplus(const SeriesSolver& series, int lane, std::size_t edge) const {
  constexpr double kUnseen =
      5e-4;  // of a travel as long as the patch is wide: what is less at a node is left out
  const ContactPoint& s = middle(edge);
  const double unit = data_.attributes.reference_displacement;
  const NearNodes near = nearNodes(setup_.surface, surface_.position(s), kEdgeReach * setup_.patch_radius);
  Eigen::MatrixXf u(Eigen::Index(3 * near.nodes.size()), Eigen::Index(rows_));
  std::vector<float> size;  // of a coefficient's share at that travel
  for (std::size_t k = 0; k < rows_; ++k) {
    const int alpha = static_cast<int>(k + kLinearCoefficients);
    const int degree = basis_[alpha][0] + basis_[alpha][1] + basis_[alpha][2];
    size.push_back(static_cast<float>(std::pow(setup_.patch_radius / unit, degree)));
    for (std::size_t i = 0; i < near.nodes.size(); ++i)
      u.block<3, 1>(Eigen::Index(3 * i), Eigen::Index(k)) =
          (std::pow(unit, degree) *
           series.displacement(lane, alpha, setup_.surface.nodes[index(near.nodes[i])]))
              .cast<float>();
  }
  subtractMixture(mixing_.at(surface_, s), near, u);
  Surplus out;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < near.nodes.size(); ++i) {
    auto own = u.middleRows<3>(Eigen::Index(3 * i));
    own *= near.window[i];
    float moved = 0.0F;
    for (std::size_t k = 0; k < rows_; ++k) moved += size[k] * own.col(Eigen::Index(k)).norm();
    if (static_cast<double>(moved) < kUnseen * setup_.patch_radius) continue;
    kept.push_back(i);
    out.nodes.push_back(near.nodes[i]);
  }
  for (std::size_t k = 0; k < rows_; ++k)
    for (const std::size_t i : kept)
      for (std::size_t c = 0; c < 3; ++c) out.field.push_back(u(Eigen::Index(3 * i + c), Eigen::Index(k)));
  return out;
}

/// Largest displacement of a node by what an edge adds at x = r e, over 26 directions e: of each degree by itself, or of all.
/// @param r  of d / d_ref  @param degree  0: all
double EdgeFields::size(const Surplus& own, double r, int degree) const {
  const Eigen::Index numbers = Eigen::Index(3 * own.nodes.size());
  if (numbers == 0) return 0.0;
  const Eigen::Map<const Eigen::MatrixXf> field(own.field.data(), numbers, Eigen::Index(rows_));
  const int first = degree == 0 ? kLinearCoefficients : basis_.begin(degree);
  const int count = (degree == 0 ? basis_.size() : basis_.begin(degree + 1)) - first;
  double most = 0.0;
  for (const Vec3& direction : sampledDirections()) {
    std::array<double, MonomialBasis::kMaxCoefficients> monomial{};
    basis_.evaluate(r * direction, monomial);
    const Eigen::VectorXf u = field.middleCols(first - kLinearCoefficients, count) *
                              Eigen::Map<const Eigen::VectorXd>(monomial.data() + first, count).cast<float>();
    most = std::max(most, double{u.reshaped(3, numbers / 3).colwise().norm().maxCoeff()});
  }
  return most;
}

/// Where the degrees beyond an edge's own are estimated to miss the asked part of abs(d): they go on as the last two do.
/// @param cap  m  @return m, at most cap
double EdgeFields::radius(const Surplus& own, double cap, double error) const {
  const int p = basis_.order();
  const double last = size(own, 1.0, p), unit = data_.attributes.reference_displacement;
  if (last == 0.0) return cap;
  const double before = p > 2 ? size(own, 1.0, p - 1) : 0.0;
  return largestTrusted(cap, [&](double d) {
    const double r = d / unit, next = before > 0.0 ? std::min(kSlowest, r * last / before) : kSlowest;
    return last * std::pow(r, p) * next <= kTooHigh * error * d * (1.0 - next);
  });
}

/// Where the mixture of the positions' forces misses the asked part of the edge's own force, in any of 26 directions: its
/// degrees two and three, and those beyond as these two go on. @return m, at most d_max of its ends
double EdgeFields::forceRadius(const SeriesSolver& series, int lane, std::size_t edge, double error) const {
  const auto [one, other] = ends(edge);
  const double unit = data_.attributes.reference_displacement;
  const auto count = static_cast<std::size_t>(basis_.size());
  const std::size_t all = data_.contact_force.size() / (3 * view_.positions());  // coefficients of a position
  const Stencil stencil = mixing_.at(surface_, middle(edge));
  std::vector<Vec3> exact(count), missed(count, Vec3::Zero());
  for (std::size_t k = 0; k < count; ++k) {
    const MultiIndex& alpha = basis_[static_cast<int>(k)];
    exact[k] = std::pow(unit, alpha[0] + alpha[1] + alpha[2]) * series.answer(lane, static_cast<int>(k));
    if (k < kLinearCoefficients) continue;
    missed[k] = exact[k];
    for (std::size_t b = 0; b < stencil.count; ++b)
      missed[k] -= stencil.weight[b] * Eigen::Map<const Vec3>(data_.contact_force.data() +
                                                              3 * (index(stencil.position[b]) * all + k));
  }
  double least = std::max(data_.contact_domain_radius[one], data_.contact_domain_radius[other]);
  for (const Vec3& direction : sampledDirections()) {
    const DegreeSums force(basis_, exact, direction), off(basis_, missed, direction);
    least = largestTrusted(least, [&](double d) {
      const double r = d / unit;
      return off.at(r).norm() + off.tail(r) <= kTooHigh * error * force.at(r).norm();
    });
  }
  return least;
}

}  // namespace palpate::solver
