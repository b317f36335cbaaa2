// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/gram_sums.h"

#include <algorithm>

namespace palpate::solver {

using Eigen::Index;
using Eigen::MatrixXf;

/// Packs the matrices wanted[first .. first + count).
void GramSums::formGrams(std::size_t first, std::size_t count, Work& work) const {
  constexpr Index kFew = 4;  // columns that no product of matrices is called for
  const Index n = columns_.rows();
  work.square.resize(n, n);
  for (std::size_t q = 0; q < count; ++q) {
    const auto B = columns_.middleCols(work.wanted[first + q] * width_, width_);
    float* out = work.grams.col(static_cast<Index>(q)).data();
    if (width_ > kFew) {
      work.square.triangularView<Eigen::Lower>().setZero();
      work.square.selfadjointView<Eigen::Lower>().rankUpdate(B);
      for (Index j = 0; j < n; ++j) out = std::copy_n(work.square.col(j).data() + j, n - j, out);
      continue;
    }
    for (Index j = 0; j < n; out += n - j, ++j) {
      Eigen::Map<Eigen::VectorXf> column(out, n - j);
      column = B(j, 0) * B.col(0).tail(n - j);
      for (Index c = 1; c < width_; ++c) column += B(j, c) * B.col(c).tail(n - j);
    }
  }
}

void GramSums::sum(std::span<const std::int32_t> inputs, std::span<const std::int32_t> receivers,
                   const Factor& factor, Work& work) const {
  constexpr std::size_t kInner = 256;  // matrices of one product
  const Index size = packedSize(columns_.rows());
  work.wanted.clear();
  for (const std::int32_t i : inputs)
    if (std::any_of(receivers.begin(), receivers.end(), [&](std::int32_t r) { return factor(i, r) != 0.0F; }))
      work.wanted.push_back(i);
  work.sums.setZero(size, static_cast<Index>(receivers.size()));
  // Always as many: a matrix of another size gets new pages from the system.
  work.grams.resize(size, static_cast<Index>(kInner));
  for (std::size_t first = 0; first < work.wanted.size(); first += kInner) {
    const std::size_t count = std::min(kInner, work.wanted.size() - first);
    formGrams(first, count, work);
    work.factors.resize(static_cast<Index>(count), work.sums.cols());
    for (std::size_t r = 0; r < receivers.size(); ++r)
      for (std::size_t q = 0; q < count; ++q)
        work.factors(static_cast<Index>(q), static_cast<Index>(r)) =
            factor(work.wanted[first + q], receivers[r]);
    work.sums.noalias() += work.grams.leftCols(static_cast<Index>(count)) * work.factors;
  }
}

}  // namespace palpate::solver
