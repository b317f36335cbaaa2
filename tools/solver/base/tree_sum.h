// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <map>
#include <mutex>
#include <span>
#include <utility>

#include "tools/solver/base/blocks.h"

namespace palpate::solver {

/// A sum of one matrix for each block, in a fixed order: neighbours in pairs, then pairs of pairs. So it has the same bits however
/// many threads and ranks there are, whichever comes first, and about log2(count) matrices wait at once.
template <class Matrix>
class TreeSum {
 public:
  TreeSum(const Blocks& blocks, Eigen::Index rows, Eigen::Index columns)
      : blocks_(blocks), rows_(rows), columns_(columns) {
    while ((std::size_t{1} << top_) < blocks.count()) ++top_;
  }
  /// What a block of this rank adds, once for each. Any thread.
  void add(std::size_t block, Matrix part) { add(Node{0, block}, std::move(part)); }
  /// The sum, on all ranks. @return rows x columns, 0 where there are no blocks
  [[nodiscard]] Matrix finish() {
    if (blocks_.count() == 0) return Matrix::Zero(rows_, columns_);
    collect({top_, 0});
    Matrix sum = blocks_.ranks().rank() == blocks_.rankOf(0) ? take({top_, 0}) : Matrix(rows_, columns_);
    blocks_.ranks().broadcast(bytesOf(sum), blocks_.rankOf(0));
    return sum;
  }

 private:
  using Node = std::pair<unsigned, std::size_t>;  // level, number: of the blocks [number, number + 1) 2^level

  [[nodiscard]] static std::size_t firstOf(const Node& node) { return node.second << node.first; }
  [[nodiscard]] static std::span<std::byte> bytesOf(Matrix& matrix) {
    return std::as_writable_bytes(std::span(matrix.data(), static_cast<std::size_t>(matrix.size())));
  }
  [[nodiscard]] Matrix take(const Node& node) {
    Matrix sum = std::move(waiting_.at(node));
    waiting_.erase(node);
    return sum;
  }

  void add(Node node, Matrix sum) {
    for (; node.first < top_; node = {node.first + 1, node.second / 2}) {
      const Node partner{node.first, node.second ^ 1U};
      if (firstOf(partner) >= blocks_.count()) continue;
      std::unique_lock lock(mutex_);
      if (waiting_.count(partner) == 0) {
        waiting_.emplace(node, std::move(sum));
        return;
      }
      const Matrix other = take(partner);
      lock.unlock();
      sum += other;
    }
    const std::lock_guard lock(mutex_);
    waiting_.emplace(node, std::move(sum));
  }

  /// The sum of a node's blocks, at the rank that has the first one.
  void collect(const Node& node) {
    const std::size_t first = firstOf(node);
    const std::size_t end = std::min(first + (std::size_t{1} << node.first), blocks_.count());
    const int to = blocks_.rankOf(first);
    if (blocks_.rankOf(end - 1) == to) return;  // it is there already
    const Node left{node.first - 1, 2 * node.second}, right{node.first - 1, 2 * node.second + 1};
    collect(left);
    if (firstOf(right) >= end) return;
    collect(right);
    const int from = blocks_.rankOf(firstOf(right)), own = blocks_.ranks().rank();
    if (from == to) return;
    Matrix sum = own == from ? take(right) : Matrix(own == to ? rows_ : 0, own == to ? columns_ : 0);
    blocks_.ranks().move(bytesOf(sum), from, to);
    if (own == to) add(right, std::move(sum));
  }

  const Blocks& blocks_;
  Eigen::Index rows_, columns_;
  unsigned top_{0};
  std::mutex mutex_;
  std::map<Node, Matrix> waiting_;
};

}  // namespace palpate::solver
