// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fit/gram_sums.h"

#include <algorithm>

namespace palpate::solver {

using Eigen::Index;
using Eigen::MatrixXf;

std::size_t GramSums::blockSize(Index n, int workers, std::size_t receivers) {
  constexpr std::size_t kBytes = 256U << 20U, kLeast = 32, kMost = 512, kBlocksEach = 4;
  const auto all = static_cast<std::size_t>(workers);
  const std::size_t fits = kBytes / (all * sizeof(float) * static_cast<std::size_t>(packedSize(n)));
  const std::size_t even = (receivers + kBlocksEach * all - 1) / (kBlocksEach * all);
  return std::max(kLeast, std::min({fits, even, kMost}));
}

/// Packs the matrices wanted[first .. first + count).
void GramSums::formGrams(std::size_t first, std::size_t count, Work& work) const {
  const Index n = columns_.rows();
  work.square.resize(n, n);
  for (std::size_t q = 0; q < count; ++q) {
    const auto B = columns_.middleCols(work.wanted[first + q] * width_, width_);
    work.square.noalias() = B * B.transpose();
    float* out = work.grams.col(static_cast<Index>(q)).data();
    for (Index j = 0; j < n; ++j) out = std::copy_n(work.square.col(j).data() + j, n - j, out);
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
  work.grams.resize(size, static_cast<Index>(std::min(kInner, work.wanted.size())));
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
