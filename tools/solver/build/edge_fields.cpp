// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/edge_fields.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "core/base/index.h"
#include "core/base/multi_index.h"
#include "core/data/model_view.h"
#include "core/model/smooth_mixing.h"
#include "core/surface/smooth_places.h"
#include "core/surface/surface_mesh.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/fit/near_field.h"
#include "tools/solver/series/domain.h"
#include "tools/solver/series/series.h"

namespace palpate::solver {

namespace {

constexpr int kMostDegree = 3;      ///< of what edges add: a fourth costs more than both and gives a tenth
constexpr double kShortest = 1.15;  ///< of an edge that adds something, in patch radii
constexpr double kReach = 3.0;      ///< of what it adds, in patch radii
constexpr std::size_t kTried = 16;  ///< edges, before the others are solved
constexpr double kSmall = 0.25;     ///< part of the asked error that edges may add and be left out

ModelView surfaceOf(const modelfile::ModelData& data) {
  ModelView view;
  view.surface_positions = data.surface_positions;
  view.surface_triangles = data.surface_triangles;
  view.surface_mesh_tag = data.surface_mesh_tag;
  view.position_of_node = data.position_of_node;
  view.contact_node = data.contact_node;
  view.contact_accessible = data.contact_accessible;
  view.contact_triangles = data.contact_triangles.empty() ? data.surface_triangles : data.contact_triangles;
  return view;
}

/// What one edge adds.
struct Surplus {
  std::vector<std::int32_t> nodes;
  std::vector<float> field;  // [Ce][nodes][3]
};

class EdgeFields {
 public:
  EdgeFields(const SolverSetup& setup, const ContactPatches& patches, int order,
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

  [[nodiscard]] std::size_t count() const { return places_.size() - view_.positions(); }
  [[nodiscard]] bool isLong(std::size_t edge) const;
  [[nodiscard]] Patch patch(std::size_t edge, PatchNodes& room) const;
  [[nodiscard]] Surplus surplus(const SeriesSolver& series, int lane, std::size_t edge) const;
  [[nodiscard]] double added(const Surplus& own, double travel) const {
    return size(own, travel / data_.attributes.reference_displacement, 0) / travel;
  }
  [[nodiscard]] double radius(const Surplus& own, double cap, double error) const;
  /// The contact positions at its ends.
  [[nodiscard]] std::array<std::size_t, 2> ends(std::size_t edge) const;

 private:
  [[nodiscard]] const ContactPoint& middle(std::size_t edge) const {
    return places_.views(view_.positions() + edge).front().s;
  }
  [[nodiscard]] double size(const Surplus& own, double r, int degree) const;
  void subtractMixture(const Stencil& stencil, const NearNodes& near, Eigen::MatrixXf& u) const;

  const SolverSetup& setup_;
  const ContactPatches& patches_;
  const modelfile::ModelData& data_;
  ModelView view_;
  SurfaceMesh surface_;
  SmoothMixing mixing_;
  SmoothPlaces places_;
  MonomialBasis basis_;
  std::size_t rows_, position_rows_, modes_;
  Eigen::Map<const Eigen::MatrixXf> X_;
};

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
      return (X[(k + 1) % 3] - X[(k + 2) % 3]).norm() > kShortest * setup_.patch_radius;
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
  const NearNodes near = nearNodes(setup_.surface, surface_.position(s), kReach * setup_.patch_radius);
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

/// Where the degrees that an edge has not are estimated to miss the asked part of abs(d): they go on as the last two do.
/// @param cap  m  @return m, at most cap
double EdgeFields::radius(const Surplus& own, double cap, double error) const {
  constexpr double kSlowest = 0.8;
  constexpr double kTooHigh = 2.0;  // the estimate over what touches miss: docs/decisions/domain.md
  constexpr int kHalvings = 12;
  const int p = basis_.order();
  const double last = size(own, 1.0, p), unit = data_.attributes.reference_displacement;
  const double ratio = p > 2 ? last / size(own, 1.0, p - 1) : 0.0;
  const auto isTrusted = [&](double d) {
    const double r = d / unit, next = std::min(kSlowest, ratio * r);
    return last * std::pow(r, p) * next <= kTooHigh * error * d * (1.0 - next);
  };
  if (last == 0.0 || isTrusted(cap)) return cap;
  double good = 0.0, bad = cap;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double middle = 0.5 * (good + bad);
    (isTrusted(middle) ? good : bad) = middle;
  }
  return good;
}

/// The second largest of what some edges add.
double secondOf(const EdgeFields& edges, const std::vector<Surplus>& surplus,
                const std::vector<std::size_t>& tried, double travel) {
  std::vector<double> added;
  for (const std::size_t edge : tried) added.push_back(edges.added(surplus[edge], travel));
  std::sort(added.begin(), added.end(), std::greater<>());
  return added[std::min<std::size_t>(1, added.size() - 1)];
}

/// Every so many of a list, and the others. @return first those
std::pair<std::vector<std::size_t>, std::vector<std::size_t>> spread(const std::vector<std::size_t>& list,
                                                                     std::size_t count) {
  std::pair<std::vector<std::size_t>, std::vector<std::size_t>> parts;
  for (std::size_t i = 0; i < list.size(); ++i)
    (i * count / list.size() != (i + 1) * count / list.size() ? parts.first : parts.second)
        .push_back(list[i]);
  return parts;
}

}  // namespace

EdgeCounts edgeCounts(const SolverSetup& setup, int order) {
  EdgeCounts counts;
  counts.degree = std::min(order, kMostDegree);
  if (counts.degree < 2) return {};
  counts.coefficients = static_cast<double>(MonomialBasis(counts.degree).size()) - kLinearCoefficients;
  std::vector<std::uint8_t> is_position(setup.surface.nodes.size(), 0);
  for (const std::int32_t node : setup.positions.nodes) is_position[index(node)] = 1;
  std::set<std::pair<std::int32_t, std::int32_t>> seen;
  double nodes = 0.0;
  for (const auto& face : setup.surface.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [one, other] = std::minmax(face[k], face[(k + 1) % 3]);
      if (is_position[index(one)] == 0 || is_position[index(other)] == 0 || !seen.emplace(one, other).second)
        continue;
      const Vec3 &X = setup.surface.positions[index(one)], &Y = setup.surface.positions[index(other)];
      if ((X - Y).norm() <= kShortest * setup.patch_radius) continue;
      if (counts.solved++ % 32 == 0)
        nodes +=
            32.0 * static_cast<double>(
                       nearNodes(setup.surface, 0.5 * (X + Y), kReach * setup.patch_radius).nodes.size());
    }
  counts.all = seen.size();
  if (counts.solved > 0) counts.nodes = nodes / static_cast<double>((counts.solved + 31) / 32 * 32);
  return counts;
}

EdgeChoice storeEdgeFields(const SolverSetup& setup, const Cholesky& factor, const ContactPatches& patches,
                           int order, const EdgeNeed& need, const BuildOptions& options,
                           modelfile::ModelData& data) {
  const int degree = std::min(order, kMostDegree);
  if (degree < 2) return {};
  const EdgeFields edges(setup, patches, degree, data);
  std::vector<std::size_t> chosen;
  for (std::size_t edge = 0; edge < edges.count(); ++edge)
    if (edges.isLong(edge)) chosen.push_back(edge);
  if (chosen.empty()) return {};
  std::vector<Surplus> surplus(edges.count());
  Progress progress("series, edge midpoints", chosen.size(), options.quiet);
  std::vector<std::unique_ptr<SeriesSolver>> solvers(static_cast<std::size_t>(options.workers));
  const auto solve = [&](const std::vector<std::size_t>& list) {
    parallelFor(options.workers, (list.size() + kLanes - 1) / kLanes, [&](int worker, std::size_t chunk) {
      auto& solver = solvers[static_cast<std::size_t>(worker)];
      if (!solver) solver = std::make_unique<SeriesSolver>(setup.model, factor, SeriesOrders{degree, degree});
      const auto of = std::span(list).subspan(chunk * kLanes);
      const std::size_t lanes = std::min<std::size_t>(kLanes, of.size());
      std::vector<Patch> loaded;
      PatchNodes room = patches.room();
      for (const std::size_t edge : of.first(lanes)) loaded.push_back(edges.patch(edge, room));
      solver->solve(loaded);
      for (std::size_t lane = 0; lane < lanes; ++lane)
        surplus[of[lane]] = edges.surplus(*solver, static_cast<int>(lane), of[lane]);
      progress.advance(lanes);
    });
  };
  const auto [tried, others] = spread(chosen, kTried);
  solve(tried);
  EdgeChoice choice{chosen.size(), 0, secondOf(edges, surplus, tried, need.travel)};
  if (choice.added <= kSmall * need.error) return choice;
  solve(others);
  choice.solved = chosen.size();
  for (const std::size_t edge : chosen)
    for (const std::size_t end : edges.ends(edge)) {
      double& domain = data.contact_domain_radius[end];
      domain = std::min(domain, edges.radius(surplus[edge], domain, need.error));
    }
  data.edge_order = degree;
  data.edge_offset.push_back(0);
  for (const Surplus& own : surplus) {
    data.edge_offset.push_back(data.edge_offset.back() + static_cast<std::int64_t>(own.nodes.size()));
    data.edge_node.insert(data.edge_node.end(), own.nodes.begin(), own.nodes.end());
    data.edge_field.insert(data.edge_field.end(), own.field.begin(), own.field.end());
  }
  return choice;
}

}  // namespace palpate::solver
