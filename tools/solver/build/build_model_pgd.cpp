// SPDX-License-Identifier: Apache-2.0
// Methods pgd-linear, pgd-explicit and pgd-euler: the paper's methods, from a case to a model.
#include "tools/solver/build/build_model_pgd.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "core/data/model_view.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/build/build_model_parts.h"
#include "tools/solver/build/store_modes.h"
#include "tools/solver/pgd/explicit_pgd.h"
#include "tools/solver/pgd/linear_pgd.h"
#include "tools/solver/pgd/parametric_problem.h"
#include "tools/solver/pgd/recompression.h"

namespace palpate::solver {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// The pairs, whatever method found them: u = sum_k X_k Y_k(s, coefficient).
struct Pairs {
  MatrixXd X;  // dofs x n
  MatrixXd Y;  // n x (M C), column position * C + coefficient, m
};

/// Contact displacement e . d along the load of 1 N at some positions, spread evenly, m/N: the median.
double medianCompliance(const SolverSetup& setup, const Cholesky& factor,
                        const std::vector<Vec3>& directions) {
  constexpr std::size_t kSamples = 64;
  std::vector<Patch> patches;
  const auto& positions = setup.positions;
  const auto accessible = static_cast<std::size_t>(
      std::count(positions.accessible.begin(), positions.accessible.end(), std::uint8_t{1}));
  const std::size_t stride = (accessible + kSamples - 1) / kSamples;  // accessible positions come first
  for (std::size_t s = 0; s < accessible; s += stride) patches.push_back(positions.patches[s]);
  const SparseMatrix loads = patchLoads(setup.model, patches, directions);
  const MatrixXd u = factor.solve(MatrixXd(loads));
  std::vector<double> compliance;
  for (Index column = 0; column < loads.cols(); ++column)
    compliance.push_back(loads.col(column).dot(u.col(column)));
  const auto middle = compliance.begin() + static_cast<std::ptrdiff_t>(compliance.size() / 2);
  std::nth_element(compliance.begin(), middle, compliance.end());
  return *middle;
}

class PgdBuilder {
 public:
  PgdBuilder(const Case& c, const mesh::TetMesh& mesh, const BuildOptions& options, BuildReport& report)
      : case_(c), mesh_(mesh), options_(options), report_(report), setup_(c, mesh) {
    if (c.load.any_direction)
      directions_ = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    else
      directions_ = {c.load.unitDirection()};
  }
  modelfile::ModelData run();

 private:
  void chooseLoad();
  [[nodiscard]] BodyProblem problem() const;
  [[nodiscard]] int greedyPairs(const BodyProblem& body) const;
  Pairs solveLinear(const BodyProblem& body);
  Pairs solveExplicitly(const BodyProblem& body);
  void checkMemory(const BodyProblem& body, const ExplicitOptions& options) const;
  void limitLevels(const BodyProblem& body, const LevelSolution& solution);
  void store(const Pairs& pairs);
  void storeLoad();
  void endWhereNothingRises();

  const Case& case_;
  const mesh::TetMesh& mesh_;
  BuildOptions options_;
  BuildReport& report_;
  SolverSetup setup_;
  std::vector<Vec3> directions_;
  double load_{0.0};    // N
  double travel_{0.0};  // of the median contact under the load, linear, m
  MatrixXd levels_;     // C x (L + 1)
  modelfile::ModelData data_;
};

/// The given load, or the load that moves the median contact by 2 mm in linear theory.
void PgdBuilder::chooseLoad() {
  constexpr double kTravel = 2e-3;  // m
  const Stopwatch watch;
  Cholesky factor(setup_.model);
  factorizeAtRest(factor, setup_, mesh_, case_);
  const double compliance = medianCompliance(setup_, factor, directions_);
  load_ = case_.load.magnitude.value_or(kTravel / compliance);
  travel_ = load_ * compliance;
  report_.load = load_;
  report_.factor_seconds = watch.seconds();
  if (!options_.quiet && !case_.load.magnitude)
    std::fprintf(stderr, "load: %.4g N, which moves the median contact by 2 mm in linear theory\n", load_);
}

BodyProblem PgdBuilder::problem() const {
  std::vector<Vec3> forces;
  for (const Vec3& direction : directions_) forces.push_back(load_ * direction);
  const std::vector<double> areas = setup_.positionAreas();
  Eigen::VectorXd weights(static_cast<Index>(areas.size() * forces.size()));
  for (std::size_t i = 0; i < areas.size() * forces.size(); ++i)
    weights[static_cast<Index>(i)] = areas[i / forces.size()];
  return BodyProblem(setup_.model, patchLoads(setup_.model, setup_.positions.patches, forces), weights);
}

/// The problem's dimension limits the number of pairs.
int PgdBuilder::greedyPairs(const BodyProblem& body) const {
  const int wanted = case_.pgd.greedy_pairs.value_or((3 * case_.modesOrDefault() + 1) / 2);
  return std::min({wanted, body.dofs(), body.positions()});
}

Pairs PgdBuilder::solveLinear(const BodyProblem& body) {
  const PgdCase& pgd = case_.pgd;
  LinearPgdOptions options;
  if (pgd.hadamard.value_or(false)) {
    options.separation = Separation::kHadamard;
    options.block = 1;
  }
  options.load_terms = case_.load.truncation.value_or(0);
  options.max_pairs = greedyPairs(body);
  options.tolerance = pgd.tolerance.value_or(options.tolerance);
  options.max_sweeps = pgd.sweeps.value_or(options.max_sweeps);
  options.update = pgd.update.value_or(options.update);
  options.block = pgd.block.value_or(options.block);
  options.workers = options_.workers;
  options.quiet = options_.quiet;
  const Stopwatch watch;
  const SeparatedSolution solution = solveLinearPgd(body, options);
  report_.pgd_seconds = watch.seconds();
  report_.greedy_pairs = static_cast<int>(solution.pairs());
  report_.load_truncation = solution.load_error;
  if (!solution.history.empty()) report_.residual = solution.history.back().residual;

  const Stopwatch recompression_watch;
  const InnerProduct energy = energyProduct(body.stiffness());
  Recompressed best = recompress(solution.scalarPairs(), energy, body.weights(), case_.modesOrDefault());
  report_.truncation = best.truncation(best.pairs.X.cols());
  report_.recompression_seconds = recompression_watch.seconds();
  levels_ = Eigen::RowVector2d(0.0, 1.0);
  data_.contact_domain_radius.assign(setup_.positions.nodes.size(), case_.load.any_direction ? load_ : 1.0);
  return {std::move(best.pairs.X), std::move(best.pairs.Y)};
}

/// Refuses cases that do not fit in memory: the pairs of every load step stay until the levels are separated.
void PgdBuilder::checkMemory(const BodyProblem& body, const ExplicitOptions& options) const {
  const double pairs = options.max_pairs, M = body.positions(), dofs = body.dofs();
  const double tangents =
      std::min(options.tangent_bytes, 8.0 * M * static_cast<double>(body.stiffness().nonZeros()));
  const double bytes = tangents + 8.0 * (2.0 * pairs * M * options.steps + M * pairs * pairs +
                                         3.0 * dofs * pairs + 2.0 * dofs * M);
  const double memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (bytes <= memory) return;
  char text[256];
  std::snprintf(
      text, sizeof text,
      "%d pairs at %.0f contact positions over %d load steps need %.1f GB, there are %.1f GB; fewer "
      "pairs (pgd.greedy_pairs, model.modes) or load.steps need less",
      options.max_pairs, M, options.steps, 1e-9 * bytes, 1e-9 * memory);
  throw CaseError(case_.mesh.string() + ": " + text);
}

Pairs PgdBuilder::solveExplicitly(const BodyProblem& body) {
  ExplicitOptions options;
  options.scheme = case_.method == Method::kPgdEuler ? LoadStepping::kForwardEuler : LoadStepping::kTenTerms;
  options.steps = case_.load.stepsOrDefault();
  options.tolerance = case_.pgd.tolerance.value_or(options.tolerance);
  options.max_pairs = greedyPairs(body);
  options.sweeps = case_.pgd.sweeps.value_or(options.sweeps);
  options.modes = case_.modesOrDefault();
  options.workers = options_.workers;
  options.quiet = options_.quiet;
  checkMemory(body, options);
  const Stopwatch watch;
  LevelSolution solution = solveExplicit(body, options);
  report_.pgd_seconds = watch.seconds();
  report_.greedy_pairs = solution.pairs;
  if (!solution.residual.empty())
    report_.residual = *std::max_element(solution.residual.begin(), solution.residual.end());
  limitLevels(body, solution);
  levels_ = solution.Z;
  return {std::move(solution.X), std::move(solution.Y)};
}

/// t_max(s): the last level before an element falls below min det F = 0.3.      docs/design.md, Series
void PgdBuilder::limitLevels(const BodyProblem& body, const LevelSolution& solution) {
  constexpr double kMinDetF = 0.3;
  constexpr int kSamples = 10;
  data_.contact_domain_radius.assign(setup_.positions.nodes.size(), 1.0);
  parallelFor(options_.workers, setup_.positions.nodes.size(), [&](int, std::size_t s) {
    for (int sample = 1; sample <= kSamples; ++sample) {
      const double t = static_cast<double>(sample) / kSamples;
      const Eigen::VectorXd u = body.toNodes(evaluate(solution, static_cast<int>(s), t));
      if (setup_.model.minDetF(u) >= kMinDetF) continue;
      data_.contact_domain_radius[s] = std::max(t - 1.0 / kSamples, 1e-3);
      break;
    }
  });
}

/// The rows of the surface nodes; each mode that is not zero there has unit mean square.
void PgdBuilder::store(const Pairs& pairs) {
  const PatchSurface& surface = setup_.surface;
  MatrixXd X = MatrixXd::Zero(static_cast<Index>(3 * surface.nodes.size()), pairs.X.cols());
  Eigen::VectorXd area(X.rows());
  for (std::size_t i = 0; i < surface.nodes.size(); ++i) {
    const auto row = static_cast<Index>(3 * i);
    area.segment<3>(row).setConstant(surface.areas[i]);
    if (const int dof = setup_.model.dof(surface.nodes[i]); dof >= 0)
      X.middleRows<3>(row) = pairs.X.middleRows<3>(dof);
  }
  area /= area.sum() / 3.0;
  Eigen::VectorXd size = (area.cwiseSqrt().asDiagonal() * X).colwise().norm();
  size = (size.array() > 0.0).select(size, 1.0);
  X *= size.cwiseInverse().asDiagonal();
  const MatrixXd Y = size.asDiagonal() * pairs.Y;
  storeModes(setup_, X.cast<float>(), Y.cast<float>(), data_);
}

/// A load of one direction has its answer per level; with three directions the answer is linear in the force.
void PgdBuilder::storeLoad() {
  ModelAttributes& a = data_.attributes;
  a.reference_displacement = travel_;
  if (case_.load.any_direction) {
    a.parameters = Parameters::kForce;
    a.order = a.force_order = 1;
    a.reference_force = load_;
    return;
  }
  a.parameters = Parameters::kLevel;
  a.load = load_;
  for (std::size_t i = 0; i < 3; ++i) a.load_direction[i] = directions_[0][static_cast<Index>(i)];
  for (Index q = 0; q < levels_.rows(); ++q)
    for (Index j = 0; j < levels_.cols(); ++j) data_.levels_Z.push_back(levels_(q, j));
  endWhereNothingRises();
}

/// The displacement along the load determines the level, so t_max(s) ends where the modes' displacement stops
/// rising.
/// @throw std::runtime_error naming a node that the modes do not move along the load
void PgdBuilder::endWhereNothingRises() {
  const Index C = levels_.rows(), steps = levels_.cols() - 1;
  for (std::size_t s = 0; s < setup_.positions.nodes.size(); ++s) {
    const Eigen::Map<const MatrixXd> d(data_.contact_displacement.data() + 3 * static_cast<Index>(s) * C, 3,
                                       C);
    const Eigen::RowVectorXd along = directions_[0].transpose() * d * levels_;
    Index rising = 0;
    while (rising < steps && along[rising + 1] > along[rising]) ++rising;
    if (rising == 0)
      throw std::runtime_error(
          case_.mesh.string() + ": node " +
          std::to_string(mesh_.node_tags[static_cast<std::size_t>(
              setup_.surface.nodes[static_cast<std::size_t>(setup_.positions.nodes[s])])]) +
          ": the modes do not move the contact along the load; raise model.modes");
    double& t_max = data_.contact_domain_radius[s];
    t_max = std::min(t_max, static_cast<double>(rising) / static_cast<double>(steps));
  }
}

modelfile::ModelData PgdBuilder::run() {
  chooseLoad();
  const BodyProblem body = problem();
  store(case_.method == Method::kPgdLinear ? solveLinear(body) : solveExplicitly(body));
  storeLoad();
  storeOrgan(setup_, mesh_, data_);
  storeAttributes(case_, setup_, data_.attributes);
  return std::move(data_);
}

}  // namespace

modelfile::ModelData buildPgd(const Case& c, const mesh::TetMesh& mesh, const BuildOptions& options,
                              BuildReport& report) {
  return PgdBuilder(c, mesh, options, report).run();
}

}  // namespace palpate::solver
