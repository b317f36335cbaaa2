// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/far_field.h"

#include <algorithm>
#include <cmath>

#include "tools/solver/base/dense_decompositions.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/fit/ball_moments.h"
#include "tools/solver/fit/far_field_fit.h"
#include "tools/solver/fit/normal_equations.h"
#include "tools/solver/fit/spatial_order.h"

namespace palpate::solver {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;

namespace {

constexpr double kAim =
    0.85;  ///< of the asked error, for modes that a part of the sources wants: all want more

}  // namespace

FarFieldFit::FarFieldFit(const FitProblem& problem, const FitOptions& options)
    : problem_(problem),
      options_(options),
      rows_(static_cast<Index>(problem.table.rows())),
      coefficients_(problem.basis.size()),
      modes_(options.modes),
      moment_factor_(momentFactor(problem.basis)),
      row_area_(rows_),
      sources_(problem.table.blocks()),
      nodes_(spatialOrder(problem.places), 1, kNodes, sources_.ranks()),
      errors_(problem.sources.size()),
      energies_(problem.sources.size(), -1.0),
      workers_(static_cast<std::size_t>(std::max(1, options.workers))) {
  const Index columns = static_cast<Index>(problem.sources.size()) * coefficients_;
  modes_ = std::min({modes_, rows_, columns});
  double total = 0.0;
  for (const double area : problem.areas) total += area;
  for (Index row = 0; row < rows_; ++row)
    row_area_[row] = problem.areas[static_cast<std::size_t>(row / 3)] / total;
  change_.setZero(rows_ / 3, static_cast<Index>(problem.sources.size()));
  for (std::size_t s = 0; s < problem.sources.size(); ++s) {
    const FitWeights& weights = problem.sources[s].weights;
    for (std::size_t j = 0; j < weights.nodes.size(); ++j)
      change_(weights.nodes[j], static_cast<Index>(s)) = weights.change[j];
  }
  result_.Y = MatrixXf::Zero(modes_, columns);
  result_.largest.assign(problem.sources.size(), 0.0F);
}

/// Sweeps go over every stride-th source from now on.
void FarFieldFit::activate(std::size_t stride) {
  active_.clear();
  active_begin_.clear();
  for (std::size_t b = 0; b <= sources_.count(); ++b) {
    active_begin_.push_back(active_.size());
    if (b == sources_.count()) break;
    for (std::size_t i = sources_.begin(b); i < sources_.begin(b + 1); ++i)
      if (i % stride == 0) active_.push_back(sources_.order()[i]);
  }
}

FarFieldFit::Sources FarFieldFit::activeOf(std::size_t block) const {
  return Sources(active_).subspan(active_begin_[block], active_begin_[block + 1] - active_begin_[block]);
}

/// The fields of some sources, columns i * coefficients_ + k, all of them scaled by reference^|alpha|: metres; and the same times
/// the weights.
void FarFieldFit::read(Sources chunk, Worker& worker) const {
  const FieldTable& table = over_all_ ? problem_.table : *principal_;
  const auto block = static_cast<std::size_t>(rows_ * coefficients_);
  worker.fields.resize(chunk.size() * block);
  worker.weighted.resize(rows_, static_cast<Index>(chunk.size()) * coefficients_);
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    float* const own = worker.fields.data() + i * block;
    table.read(static_cast<std::size_t>(chunk[i]), std::span(own, block));
    Eigen::Map<MatrixXf> A(own, rows_, coefficients_);
    for (Index k = 0; over_all_ && k < coefficients_; ++k) {
      const MultiIndex& a = problem_.basis[static_cast<int>(k)];
      A.col(k) *= static_cast<float>(std::pow(problem_.reference, a[0] + a[1] + a[2]));
    }
    weigh(chunk[i], static_cast<Index>(i) * coefficients_, worker);
  }
}

/// Worker::weighted <- Worker::fields times the weights, for one source.
void FarFieldFit::weigh(std::int32_t s, Index column, Worker& worker) const {
  const Eigen::VectorXf weight =
      (change_.col(s).array() + 1.0F).matrix().transpose().replicate<3, 1>().reshaped();
  const Eigen::Map<const MatrixXf> fields(worker.fields.data(), rows_, worker.weighted.cols());
  worker.weighted.middleCols(column, coefficients_) =
      weight.asDiagonal() * fields.middleCols(column, coefficients_);
}

/// C x C: times this, the columns of one source are orthonormal in the mean over its ball,
/// relative to |d| (or to the size of its displacements times |f| / f_ref). Principal fields are.
MatrixXf FarFieldFit::whitening(std::int32_t s) const {
  if (!over_all_) return MatrixXf::Identity(coefficients_, coefficients_);
  const double travel = source(s).ball_radius / problem_.reference;
  MatrixXd D = moment_factor_;
  for (Index k = 0; k < coefficients_; ++k) {
    const MultiIndex& a = problem_.basis[static_cast<int>(k)];
    D.row(k) *= std::pow(std::max(travel, 1e-3), a[0] + a[1] + a[2] - 1) / source(s).size;
  }
  return D.cast<float>();
}

/// Of all sources of this rank: the whitened fields' directions of largest energy in the weights, once for all sweeps.
void FarFieldFit::findPrincipal() {
  if (options_.scratch.empty() || coefficients_ <= kPrincipal) return;
  principal_ = std::make_unique<FieldTable>(ScratchPlace(options_.scratch), sources_, std::size_t{kPrincipal},
                                            problem_.table.rows());
  principal_of_.setZero(kPrincipal, result_.Y.cols());
  activate(1);
  forOwn(sources_, [&](Worker& worker, std::size_t block) {
    MatrixXf fields;
    for (const std::int32_t s : activeOf(block)) {
      read(Sources(&s, 1), worker);
      const Eigen::Map<const MatrixXf> A(worker.fields.data(), rows_, coefficients_);
      requireFinite(A, s);
      const MatrixXd W = whitening(s).cast<double>();
      const MatrixXf weighted = row_area_.cast<float>().asDiagonal() * worker.weighted;
      const MatrixXf gram = A.transpose() * weighted;
      const MatrixXd V = eigenpairs(W.transpose() * gram.cast<double>() * W).V.leftCols(kPrincipal);
      fields.noalias() = A * (W * V).cast<float>();
      principal_->write(static_cast<std::size_t>(s),
                        {fields.data(), static_cast<std::size_t>(fields.size())});
      columnsOf(principal_of_, s) =
          W.transpose().triangularView<Eigen::Upper>().solve(V).transpose().cast<float>();
    }
  });
  sweepOver(false);
  modes_ = std::min(modes_, result_.Y.cols());
}

/// From here on. The next sweep finds the Y.
void FarFieldFit::sweepOver(bool all) {
  if (!principal_) return;
  over_all_ = all;
  coefficients_ = all ? problem_.basis.size() : kPrincipal;
  result_.Y = MatrixXf::Zero(modes_, static_cast<Index>(problem_.sources.size()) * coefficients_);
  std::fill(energies_.begin(), energies_.end(), -1.0);
}

/// The Y of some sources side by side, each times its whitening.
MatrixXd FarFieldFit::whitenedY(Sources sources) {
  MatrixXd Z(modes_, static_cast<Index>(sources.size()) * coefficients_);
  for (std::size_t i = 0; i < sources.size(); ++i)
    Z.middleCols(static_cast<Index>(i) * coefficients_, coefficients_) =
        (columnsOf(result_.Y, sources[i]) * whitening(sources[i])).cast<double>();
  return Z;
}

/// Every rank gets the Y of all sources.
void FarFieldFit::shareY() {
  const auto size = static_cast<std::size_t>(modes_ * coefficients_);
  share(sources_, [&](std::int32_t s) {
    return std::span(result_.Y.data() + static_cast<std::size_t>(s) * size, size);
  });
}

/// Every fourth source is enough to begin with, where that leaves many times more columns than modes.
std::size_t FarFieldFit::headStride() const {
  constexpr Index kColumnsPerMode = 8;
  const Index all = static_cast<Index>(problem_.sources.size()) * coefficients_;
  const Index most = std::max<Index>(modes_, options_.error > 0.0 ? options_.most_modes : 0);
  return static_cast<std::size_t>(std::clamp<Index>(all / (kColumnsPerMode * most), 1, 4));
}

/// 95 of 100 active sources have no larger error.
double FarFieldFit::quantileOfLargest() const {
  std::vector<float> list;
  for (const std::int32_t s : active_) list.push_back(result_.largest[static_cast<std::size_t>(s)]);
  const std::size_t at = list.size() - 1 - list.size() / 20;
  std::nth_element(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(at), list.end());
  return double{list[at]};
}

/// Modes that bring an error down to what is asked: it falls about as n^-1.5.
Index FarFieldFit::modesFor(double error, double asked) const {
  const double n = static_cast<double>(modes_) * std::pow(error / asked, 1.0 / 1.5);
  const double most = std::min({static_cast<double>(options_.most_modes), 2.0 * static_cast<double>(modes_),
                                static_cast<double>(std::min(rows_, result_.Y.cols()))});
  return static_cast<Index>(std::ceil(std::min(most, std::max(n, static_cast<double>(modes_) + 8.0))));
}

/// A basis from a part of the sources, of as many modes as the asked error wants.
void FarFieldFit::headStart() {
  activate(options_.head_start > 0 ? headStride() : 1);
  sketch();
  for (int i = 1; i <= options_.head_start; ++i)
    sweep(i == options_.head_start ? Step::kMeasured : Step::kPlain);
  for (int round = 0; round < 4 && options_.error > 0.0; ++round) {
    sweep(Step::kLast);
    const double error = quantileOfLargest();
    if (error <= options_.error || modes_ >= options_.most_modes) break;
    const Index before = modes_;
    grow(modesFor(error, kAim * options_.error));
    if (modes_ == before) break;  // the table has no more
    for (int i = 0; i < 2; ++i) sweep(Step::kPlain);
  }
  activate(1);
  result_.errors.clear();
}

void FarFieldFit::sweepAll(Progress& progress) {
  const int plain = options_.sweeps - options_.reweighted;
  for (int i = 1; i <= options_.sweeps; ++i) {
    sweep(i < plain ? Step::kPlain : i == plain ? Step::kMeasured : Step::kReweighted);
    progress.advance();
  }
  sweepOver(true);
  sweep(Step::kLast);
}

FarField FarFieldFit::run() {
  Progress progress("far field", static_cast<std::size_t>(options_.sweeps) + 4, options_.quiet);
  findPrincipal();
  progress.advance();
  headStart();
  progress.advance();
  sweepAll(progress);
  progress.advance();
  while (options_.error > 0.0 && quantileOfLargest() > options_.error && modes_ < options_.most_modes) {
    const Index before = modes_;
    grow(modesFor(quantileOfLargest(), options_.error));
    if (modes_ == before) break;  // the table has no more
    sweepOver(false);
    sweep(Step::kReweighted);
    sweepOver(true);
    sweep(Step::kLast);
  }
  shareY();
  orderByEnergy();
  progress.advance();
  return std::move(result_);
}

MatrixXf FarFieldFit::amplitudes(const MatrixXf& X) {
  modes_ = X.cols();  // however few the sources are
  result_.X = X;
  result_.Y.setZero(modes_, result_.Y.cols());
  activate(1);
  sweep(Step::kAmplitudes);
  return std::move(result_.Y);
}

MatrixXf amplitudesOf(const FitProblem& problem, const MatrixXf& X, int workers) {
  FitOptions options;
  options.modes = static_cast<int>(X.cols());
  options.workers = workers;
  return FarFieldFit(problem, options).amplitudes(X);
}

FarField fitFarField(const FitProblem& problem, const FitOptions& options) {
  if (problem.sources.empty() || options.modes < 1)
    throw FitError("nothing to fit: no contact positions or no modes");
  return FarFieldFit(problem, options).run();
}

}  // namespace palpate::solver
