// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/force_series.h"
// Method series-force: the series driven by force, compressed to modes.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/multi_index.h"
#include "core/data/model_view.h"
#include "tools/solver/base/lanes.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/build/build_model_parts.h"
#include "tools/solver/build/store_modes.h"
#include "tools/solver/fit/far_field.h"
#include "tools/solver/series/domain.h"

namespace palpate::solver {

namespace {

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class ForceBuilder {
 public:
  ForceBuilder(const Case& c, const mesh::TetMesh& mesh, const BuildOptions& options, BuildReport& report)
      : case_(c),
        mesh_(mesh),
        options_(options),
        report_(report),
        setup_(c, mesh),
        basis_(c.orders().fields),
        radius_(setup_.positions.nodes.size()),
        compliance_(setup_.positions.nodes.size()) {}
  std::vector<modelfile::ModelData> run(std::span<const FitSize> sizes);

 private:
  void solveSeries(FieldTable& table);
  modelfile::ModelData compress(const FieldTable& table, const FitSize& fit_size);
  void fit(const FieldTable& table, const FitSize& fit_size);
  void limitToWhatTheModesAnswer();

  const Case& case_;
  const mesh::TetMesh& mesh_;
  BuildOptions options_;
  BuildReport& report_;
  SolverSetup setup_;
  MonomialBasis basis_;
  std::vector<double> radius_;      // f_max(s) of the series, N
  std::vector<double> compliance_;  // |C_s| / sqrt(3), m/N
  double f_ref_{0.0};
  modelfile::ModelData data_;
};

void ForceBuilder::solveSeries(FieldTable& table) {
  Stopwatch factor_watch;
  Cholesky factor(setup_.model);
  factorizeAtRest(factor, setup_, mesh_, case_);
  report_.factor_seconds = factor_watch.seconds();
  const Stopwatch series_watch;
  solveAllSeries(setup_, mesh_, case_, factor, SeriesKind::kForce, options_, table,
                 {2,
                  [](const SeriesSolver& series, int lane, const SeriesRadii& radii) {
                    Mat3 C;
                    for (int k = 0; k < 3; ++k) C.col(k) = series.answer(lane, k);
                    return std::vector<double>{radii.series, C.norm() / std::sqrt(3.0)};
                  },
                  [&](std::size_t position, std::span<const double> numbers) {
                    radius_[position] = numbers[0];
                    compliance_[position] = numbers[1];
                  }});
  report_.series_seconds = series_watch.seconds();
}

/// The best modes in the area product, with relative errors per position, so that soft spots do not outweigh
/// stiff ones. No near field represents the dimple here, so every node keeps its full weight.
///                                                                               docs/design.md, Reproduction
void ForceBuilder::fit(const FieldTable& table, const FitSize& fit_size) {
  const Stopwatch watch;
  std::vector<FitSource> sources;
  for (std::size_t s = 0; s < radius_.size(); ++s)
    sources.push_back({setup_.surface.positions[static_cast<std::size_t>(setup_.positions.nodes[s])],
                       {},
                       radius_[s],
                       f_ref_ * compliance_[s]});
  const FitProblem problem{table, basis_, setup_.surface.areas, setup_.surface.positions, sources, f_ref_};
  FitOptions options;
  options.modes = fit_size.modes;
  options.sweeps = fit_size.sweeps;
  options.workers = options_.workers;
  options.quiet = options_.quiet;
  const FarField modes = fitFarField(problem, options);
  report_.fit_errors = modes.errors;
  storeModes(setup_, modes.X, modes.Y, data_);
  report_.fit_seconds = watch.seconds();
}

/// Few modes may not resolve all directions: where their dd/df is not positive definite, no force belongs to
/// a displacement. Such a position keeps a thousandth of its domain and counts as weak.
void ForceBuilder::limitToWhatTheModesAnswer() {
  constexpr double kLeast = 1e-3;
  const auto C = static_cast<std::size_t>(basis_.size());
  data_.contact_domain_radius = radius_;
  for (std::size_t s = 0; s < radius_.size(); ++s) {
    std::vector<Vec3> d(C);
    for (std::size_t k = 0; k < C; ++k)
      d[k] = Eigen::Map<const Vec3>(data_.contact_displacement.data() + 3 * (s * C + k));
    const double within =
        answerRadius(basis_, d, basis_.order(), radius_[s] / f_ref_, std::numeric_limits<double>::infinity());
    if (within < kLeast * radius_[s] / f_ref_) ++report_.weak_positions;
    data_.contact_domain_radius[s] = std::max(within * f_ref_, kLeast * radius_[s]);
  }
}

modelfile::ModelData ForceBuilder::compress(const FieldTable& table, const FitSize& fit_size) {
  data_ = {};
  report_.weak_positions = 0;
  fit(table, fit_size);
  limitToWhatTheModesAnswer();
  storeOrgan(setup_, mesh_, data_);
  ModelAttributes& a = data_.attributes;
  storeAttributes(case_, setup_, a);
  a.parameters = Parameters::kForce;
  a.order = a.force_order = basis_.order();
  a.reference_force = f_ref_;
  a.reference_displacement = 0.5 * setup_.patch_radius;
  return std::move(data_);
}

std::vector<modelfile::ModelData> ForceBuilder::run(std::span<const FitSize> sizes) {
  const SerialBlas serial;
  FieldTable table(options_.scratchFile("series"),
                   blocksOf(setup_, setup_.positions.nodes, kLanes, *options_.ranks),
                   static_cast<std::size_t>(basis_.size()), 3 * setup_.surface.nodes.size());
  solveSeries(table);
  f_ref_ = medianOf(radius_);
  std::vector<modelfile::ModelData> models;
  for (const FitSize& size : sizes) models.push_back(compress(table, size));
  return models;
}

}  // namespace

std::vector<modelfile::ModelData> buildForceSeries(const Case& c, const mesh::TetMesh& mesh,
                                                   const BuildOptions& options,
                                                   std::span<const FitSize> sizes, BuildReport& report) {
  return ForceBuilder(c, mesh, options, report).run(sizes);
}

}  // namespace palpate::solver
