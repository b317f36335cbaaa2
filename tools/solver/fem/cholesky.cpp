// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/cholesky.h"

#include <cholmod.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace palpate::solver {

namespace {

/// Columns of the lower triangle of the node graph, 3 x 3 blocks expanded; new values overwrite the old ones.
struct Pattern {
  std::vector<int> column_start;  // dofs + 1
  std::vector<int> row;           // ascending in each column
};

Pattern lowerPattern(const FeModel& model) {
  const auto node_count = static_cast<std::size_t>(model.nodeCount());
  std::vector<std::vector<int>> lower(node_count);  // dofs of the neighbours with dof >= own
  for (int e = 0; e < model.elementCount(); ++e)
    for (const int a : model.elementNodes(e))
      for (const int b : model.elementNodes(e))
        if (model.isFree(a) && model.isFree(b) && b >= a)
          lower[static_cast<std::size_t>(a)].push_back(model.dof(b));
  Pattern pattern;
  pattern.column_start.push_back(0);
  for (int node = 0; node < model.nodeCount(); ++node) {
    if (!model.isFree(node)) continue;
    auto& neighbours = lower[static_cast<std::size_t>(node)];
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    for (int c = 0; c < 3; ++c) {
      for (const int first : neighbours)
        for (int r = 0; r < 3; ++r)
          if (first + r >= model.dof(node) + c) pattern.row.push_back(first + r);
      pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
    }
  }
  return pattern;
}

Pattern lowerPattern(const SparseMatrix& K) {
  Pattern pattern;
  pattern.column_start.push_back(0);
  for (int column = 0; column < K.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry(K, column); entry; ++entry)
      if (entry.row() >= column) pattern.row.push_back(static_cast<int>(entry.row()));
    pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
  }
  return pattern;
}

class Common {
 public:
  Common() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_METIS;
    common_.postorder = 1;
    common_.supernodal = CHOLMOD_SUPERNODAL;
  }
  ~Common() { cholmod_finish(&common_); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
  cholmod_common* get() { return &common_; }

 private:
  cholmod_common common_{};
};

cholmod_dense view(Eigen::Ref<Eigen::MatrixXd> b) {
  cholmod_dense dense{};
  dense.nrow = static_cast<std::size_t>(b.rows());
  dense.ncol = static_cast<std::size_t>(b.cols());
  dense.d = static_cast<std::size_t>(b.outerStride());
  dense.nzmax = dense.d * dense.ncol;
  dense.x = b.data();
  dense.xtype = CHOLMOD_REAL;
  dense.dtype = CHOLMOD_DOUBLE;
  return dense;
}

}  // namespace

struct Cholesky::State {
  State(const FeModel* fe, Pattern p) : model(fe), pattern(std::move(p)), values(pattern.row.size()) {
    matrix.nrow = matrix.ncol = pattern.column_start.size() - 1;
    matrix.nzmax = values.size();
    matrix.p = pattern.column_start.data();
    matrix.i = pattern.row.data();
    matrix.x = values.data();
    matrix.stype = -1;
    matrix.itype = CHOLMOD_INT;
    matrix.xtype = CHOLMOD_REAL;
    matrix.dtype = CHOLMOD_DOUBLE;
    matrix.sorted = 1;
    matrix.packed = 1;
    definite = cholmod_analyze(&matrix, common.get());
    if (definite == nullptr) throw std::runtime_error("CHOLMOD could not analyse the stiffness matrix");
  }
  ~State() {
    cholmod_free_factor(&definite, common.get());
    if (indefinite != nullptr) cholmod_free_factor(&indefinite, common.get());
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void add(int row, int column, double value) {
    if (row < column) return;
    const auto begin = pattern.row.begin() + pattern.column_start[static_cast<std::size_t>(column)];
    const auto end = pattern.row.begin() + pattern.column_start[static_cast<std::size_t>(column) + 1];
    values[static_cast<std::size_t>(std::lower_bound(begin, end, row) - pattern.row.begin())] += value;
  }

  void assemble(const Eigen::VectorXd& u) {
    std::fill(values.begin(), values.end(), 0.0);
    for (int e = 0; e < model->elementCount(); ++e) {
      const FeModel::ElementMatrix K = model->elementTangent(e, u);
      const std::span<const std::int32_t> nodes = model->elementNodes(e);
      for (int a = 0; a < K.rows(); ++a) {
        const int row = model->dof(nodes[static_cast<std::size_t>(a / 3)]);
        if (row < 0) continue;
        for (int b = 0; b < K.cols(); ++b) {
          const int column = model->dof(nodes[static_cast<std::size_t>(b / 3)]);
          if (column >= 0) add(row + a % 3, column + b % 3, K(a, b));
        }
      }
    }
  }

  void copy(const SparseMatrix& K) {
    const auto require = [](bool same) {
      if (!same) throw std::invalid_argument("a matrix of another pattern than the one that was analysed");
    };
    std::size_t next = 0;
    for (int column = 0; column < K.outerSize(); ++column) {
      for (SparseMatrix::InnerIterator entry(K, column); entry; ++entry) {
        if (entry.row() < column) continue;
        require(next < values.size() && pattern.row[next] == entry.row());
        values[next++] = entry.value();
      }
      require(static_cast<int>(next) == pattern.column_start[static_cast<std::size_t>(column) + 1]);
    }
  }
  void factorize();

  [[nodiscard]] cholmod_factor* active() const { return positive ? definite : indefinite; }

  const FeModel* model;  // null for a given matrix
  Pattern pattern;
  std::vector<double> values;
  Common common;
  cholmod_sparse matrix{};
  cholmod_factor* definite{nullptr};
  cholmod_factor* indefinite{nullptr};
  bool positive{true};
  int indefinite_at{-1};  // unknown
};

Cholesky::Cholesky(const FeModel& model) : state_(std::make_unique<State>(&model, lowerPattern(model))) {}
Cholesky::Cholesky(const SparseMatrix& K) : state_(std::make_unique<State>(nullptr, lowerPattern(K))) {
  factorize(K);
}
Cholesky::~Cholesky() = default;

std::optional<int> Cholesky::indefiniteAt() const noexcept {
  return state_->positive ? std::nullopt : std::optional(state_->indefinite_at);
}

void Cholesky::requirePositiveDefinite(const std::string& matrix) const {
  if (const std::optional<int> unknown = indefiniteAt())
    throw std::runtime_error(matrix + " is not positive definite, at unknown " + std::to_string(*unknown) +
                             " of " + std::to_string(state_->matrix.nrow));
}
std::span<const int> Cholesky::order() const noexcept {
  const cholmod_factor* factor = state_->active();
  return {static_cast<const int*>(factor->Perm), factor->n};
}
Supernodes Cholesky::supernodes() const {
  const cholmod_factor* factor = state_->active();
  if (factor->is_super == 0)
    throw std::invalid_argument("supernodes of a matrix that is not positive definite");
  const auto list = [](const void* numbers, std::size_t count) {
    return std::span(static_cast<const int*>(numbers), count);
  };
  return {list(factor->super, factor->nsuper + 1), list(factor->pi, factor->nsuper + 1),
          list(factor->px, factor->nsuper + 1), list(factor->s, factor->ssize),
          static_cast<const double*>(factor->x)};
}
double Cholesky::factorSize() const noexcept {
  return state_->common.get()->lnz;
}

void Cholesky::factorize(const Eigen::VectorXd& u) {
  if (state_->model == nullptr) throw std::logic_error("a factor of a matrix has no displacement");
  state_->assemble(u);
  state_->factorize();
}

void Cholesky::factorize(const SparseMatrix& K) {
  if (static_cast<std::size_t>(K.rows()) != state_->matrix.nrow || K.rows() != K.cols())
    throw std::invalid_argument("a matrix of another size than the one that was analysed");
  state_->copy(K);
  state_->factorize();
}

void Cholesky::State::factorize() {
  // Where a pivot is not positive (L D L^T: zero), CHOLMOD succeeds with a warning and says in which row.
  const auto run = [this](cholmod_factor* factor) -> std::optional<int> {
    if (cholmod_factorize(&matrix, factor, common.get()) == 0) {
      if (common.get()->status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
      throw std::runtime_error("CHOLMOD could not factorize the stiffness matrix (code " +
                               std::to_string(common.get()->status) + ")");
    }
    if (factor->minor == factor->n) return std::nullopt;
    return static_cast<const int*>(factor->Perm)[factor->minor];
  };
  const std::optional<int> stopped = run(definite);
  positive = !stopped;
  if (positive) return;
  indefinite_at = *stopped;
  common.get()->supernodal = CHOLMOD_SIMPLICIAL;
  if (indefinite == nullptr) indefinite = cholmod_analyze(&matrix, common.get());
  common.get()->supernodal = CHOLMOD_SUPERNODAL;
  if (indefinite == nullptr) throw std::runtime_error("CHOLMOD could not analyse the stiffness matrix");
  if (const std::optional<int> singular = run(indefinite))
    throw std::runtime_error("the tangent stiffness is singular, at unknown " + std::to_string(*singular) +
                             " of " + std::to_string(matrix.nrow));
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = b;
  Solver(*this).solveInPlace(x);
  return x;
}

struct Cholesky::Solver::State {
  explicit State(cholmod_factor* f) : factor(f) {}
  ~State() {
    cholmod_free_dense(&X, common.get());
    cholmod_free_dense(&Y, common.get());
    cholmod_free_dense(&E, common.get());
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  cholmod_factor* factor;
  Common common;
  cholmod_dense* X{nullptr};
  cholmod_dense* Y{nullptr};
  cholmod_dense* E{nullptr};
};

Cholesky::Solver::Solver(const Cholesky& factor) : state_(std::make_unique<State>(factor.state_->active())) {}
Cholesky::Solver::~Solver() = default;

void Cholesky::Solver::solveInPlace(Eigen::Ref<Eigen::MatrixXd> b) {
  State& s = *state_;
  cholmod_dense rhs = view(b);
  if (cholmod_solve2(CHOLMOD_A, s.factor, &rhs, nullptr, &s.X, nullptr, &s.Y, &s.E, s.common.get()) == 0)
    throw std::runtime_error("CHOLMOD could not solve with the factor of the stiffness matrix");
  b = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>(
      static_cast<const double*>(s.X->x), b.rows(), b.cols(),
      Eigen::OuterStride<>(static_cast<Eigen::Index>(s.X->d)));
}

}  // namespace palpate::solver
