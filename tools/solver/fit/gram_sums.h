// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace palpate::solver {

/// S_r = sum_i c_ri B_i B_i^T for many receivers r at once. Each B_i B_i^T is formed once a block of receivers, as a
/// packed lower triangle; the sums of the block are one matrix product.                    docs/design.md, Parts
class GramSums {
 public:
  /// @param columns  n x (count width), kept by reference: B_i is the i-th group of `width` columns
  GramSums(const Eigen::MatrixXf& columns, Eigen::Index width) : columns_(columns), width_(width) {}

  /// Numbers in a packed lower triangle, column by column.
  [[nodiscard]] static Eigen::Index packedSize(Eigen::Index n) { return n * (n + 1) / 2; }

  /// What sum() needs, kept from block to block.
  struct Work {
    Eigen::MatrixXf sums;  ///< out: packed, one column for each receiver
    Eigen::MatrixXf grams, factors, square;
    std::vector<std::int32_t> wanted;
  };

  /// c_ri. Called from several threads.
  using Factor = std::function<float(std::int32_t i, std::int32_t r)>;

  /// Cost n (n + 1) x receivers x (matrices with a factor that is not 0 for any of them): receivers close together are
  /// cheap.
  /// @param inputs, receivers  the i and r, as the factor knows them
  void sum(std::span<const std::int32_t> inputs, std::span<const std::int32_t> receivers,
           const Factor& factor, Work& work) const;

 private:
  void formGrams(std::size_t first, std::size_t count, Work& work) const;

  const Eigen::MatrixXf& columns_;
  Eigen::Index width_;
};

}  // namespace palpate::solver
