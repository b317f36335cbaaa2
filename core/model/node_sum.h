// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/index.h"
#include "core/base/kernels.h"
#include "core/base/types.h"

namespace palpate {

/// Near fields of several sources added up: kTogether vectors or one matrix for each node, zero at most nodes. Its memory is
/// made once, so that a tick can fill it.
class NodeSum {
 public:
  using Vectors = Eigen::Matrix<double, 3, kTogether>;

  /// @param nodes  Ns
  explicit NodeSum(std::size_t nodes) : u_(nodes), reached_(nodes), is_reached_(nodes) {}

  /// Zero at the nodes that were reached, which stay reached. Real-time: yes.
  void zero() noexcept PALPATE_NONBLOCKING;
  /// zero(), and no node is reached. Real-time: yes.
  void clear() noexcept PALPATE_NONBLOCKING;
  /// Says which nodes are added to. Real-time: yes.
  void reach(std::span<const std::int32_t> nodes) noexcept PALPATE_NONBLOCKING;
  /// [Ns][kNodeFloats], of which nodes that were reached may be changed.
  [[nodiscard]] float* data() noexcept { return u_.data()->number.data(); }
  [[nodiscard]] const float* data() const noexcept { return u_.data()->number.data(); }
  [[nodiscard]] Vectors at(std::int32_t node) const noexcept PALPATE_NONBLOCKING {
    return vectorsOf(u_[index(node)].number.data());
  }
  /// The matrix of a node, where these are added up.
  [[nodiscard]] Eigen::Matrix3f matrixAt(std::int32_t node) const noexcept PALPATE_NONBLOCKING {
    return Eigen::Map<const Eigen::Matrix3f>(u_[index(node)].number.data());
  }
  /// Nodes that were reached, each once.
  [[nodiscard]] std::span<const std::int32_t> reached() const noexcept PALPATE_NONBLOCKING {
    return std::span(reached_).first(count_);
  }
  /// @param from  [kNodeFloats]
  [[nodiscard]] static Vectors vectorsOf(const float* from) noexcept PALPATE_NONBLOCKING {
    return Eigen::Map<const Eigen::Matrix<float, 4, kTogether>>(from).topRows<3>().cast<double>();
  }

 private:
  struct alignas(64) Node {  // in one line of the processor's cache
    std::array<float, kNodeFloats> number{};
  };
  std::vector<Node> u_;
  std::vector<std::int32_t> reached_;  // the first count_
  std::size_t count_{0};
  std::vector<std::uint8_t> is_reached_;  // [Ns]
};

}  // namespace palpate
