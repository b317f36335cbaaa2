// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tools/solver/base/blocks.h"
#include "tools/solver/base/progress.h"
#include "tools/solver/base/tree_sum.h"
#include "tools/solver/fit/fit_problem.h"
#include "tools/solver/fit/gram_sums.h"

namespace palpate::solver {

/// The work of fitFarField(): a sketch, then sweeps of a Y-step and an X-step each (far_field_fit.cpp). Each rank has the Y of the
/// sources whose fields it has, and the X of a part of the nodes, until both are shared. Sweeps go over the principal fields of
/// each source, where it has scratch for them; the last one of all goes over all coefficients.
class FarFieldFit {
 public:
  /// Principal fields of a source. Far from a patch its load acts by its resultant and its first moments, 3 and 9 numbers, however
  /// many coefficients the polynomial in d has (Saint-Venant's principle).                docs/decisions/three_parts.md
  static constexpr Eigen::Index kPrincipal = 12;
  static constexpr std::size_t kNodes = 128;  ///< of a block: their matrices share those of the sources

  FarFieldFit(const FitProblem& problem, const FitOptions& options);
  FarField run();
  /// Y of this rank's sources for these modes, m. @param X  3 Ns x n
  Eigen::MatrixXf amplitudes(const Eigen::MatrixXf& X);

 private:
  static constexpr std::size_t kChunk = 32;  // sources per product with the table
  struct Worker {
    std::vector<float> fields;
    Eigen::MatrixXf weighted;  // 3 Ns x (sources of the chunk C): fields times their weights, m
    GramSums::Work grams;
  };
  struct Errors {         // of a source
    double error{0.0};    // weighted square of the remainder
    double energy{0.0};   // weighted square of the field
    double seen{0.0};     // sum of the errors seen near it, over d
    double count{0.0};    // of them
    double largest{0.0};  // FarField::largest
  };
  enum class Step : std::uint8_t { kPlain, kMeasured, kReweighted, kLast, kAmplitudes };
  using Sources = std::span<const std::int32_t>;
  [[nodiscard]] const FitSource& source(std::int32_t s) const {
    return problem_.sources[static_cast<std::size_t>(s)];
  }
  [[nodiscard]] auto columnsOf(Eigen::MatrixXf& M, std::int32_t s) const {
    return M.middleCols(s * coefficients_, coefficients_);
  }
  void forOwn(const Blocks& blocks, const std::function<void(Worker&, std::size_t block)>& work);
  [[nodiscard]] Sources activeOf(std::size_t block) const;
  [[nodiscard]] static std::vector<Sources> chunksOf(Sources sources);
  void read(Sources chunk, Worker& worker) const;
  void weigh(std::int32_t source, Eigen::Index column, Worker& worker) const;
  [[nodiscard]] Eigen::MatrixXf whitening(std::int32_t source) const;
  [[nodiscard]] Eigen::MatrixXd whitenedY(Sources sources);
  static void requireFinite(const Eigen::Ref<const Eigen::MatrixXf>& fields, std::int32_t source);
  void findPrincipal();
  void sweepOver(bool all);
  void activate(std::size_t stride);
  [[nodiscard]] std::size_t headStride() const;
  [[nodiscard]] Eigen::MatrixXf noise(Sources chunk, Eigen::Index count) const;
  void sketch();
  void grow(Eigen::Index modes);
  void orthonormalize(Eigen::MatrixXd Xt);
  [[nodiscard]] Eigen::MatrixXd columnsOfNodes(const Eigen::MatrixXd& Xt, std::size_t block) const;
  void headStart();
  void sweepAll(Progress& progress);
  [[nodiscard]] double quantileOfLargest() const;
  [[nodiscard]] Eigen::Index modesFor(double error, double asked) const;
  void sweep(Step step);
  void solveY(Sources block, const GramSums& grams, Step step, Worker& worker, Eigen::MatrixXf& rhs);
  void addUpErrors();
  void shareY();
  void subtractModes(Sources chunk, Worker& worker);
  void measure(Sources chunk, bool reweight, Worker& worker);
  [[nodiscard]] Eigen::MatrixXf directions(std::int32_t source) const;
  void moveWeights(std::int32_t source, const Eigen::VectorXf& errors, Eigen::Index column, Worker& worker);
  void addError(std::int32_t s, Eigen::Index column, const Eigen::MatrixXd& b, const Worker& worker);
  void feedX(Sources chunk, const Worker& worker, Eigen::MatrixXf& rhs);
  void solveX(const Eigen::MatrixXf& rhs);
  [[nodiscard]] bool whitenAll(Eigen::MatrixXf& Z, Eigen::LLT<Eigen::MatrixXd>& llt);
  void orderByEnergy();

  const FitProblem& problem_;
  FitOptions options_;
  Eigen::Index rows_, coefficients_,
      modes_;                         // coefficients_: columns of a source, of its principal fields or of all
  Eigen::MatrixXd moment_factor_;     // C x C
  Eigen::VectorXd row_area_;          // 3 Ns, sums to 3
  const Blocks& sources_;             // of the table
  Blocks nodes_;                      // of the X-step
  std::vector<std::int32_t> active_;  // the sources that sweeps go over, in order
  std::vector<std::size_t> active_begin_;  // by block of sources, and the end; offsets into active_
  Eigen::MatrixXf change_;                 // Ns x M: weight - 1, moved by sweeps
  double mean_seen_{0.0};                  // mean error near the sources, of the last measure
  std::vector<Errors> errors_;             // of each source, of the last sweep
  std::vector<double> energies_;           // weighted squares of each source's field, negative: not known yet
  Eigen::MatrixXd area_gram_;              // X^T diag(area) X, n x n
  Eigen::MatrixXf area_X_;                 // diag(area) X
  std::unique_ptr<FieldTable> principal_;  // [source][kPrincipal][row]; null: sweeps go over all coefficients
  Eigen::MatrixXf principal_of_;           // kPrincipal x (M C): a field is the principal ones times this
  bool over_all_{true};
  FarField result_;
  std::vector<Worker> workers_;
};

}  // namespace palpate::solver
