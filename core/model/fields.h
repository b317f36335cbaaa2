// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/types.h"
#include "core/data/model_view.h"

namespace palpate {

/// Amplitudes of the modes, a block of rows for each source: Y of contact positions, or of nodes under unit loads. Borrows.
class Amplitudes {
 public:
  /// @param Y  [sources][rows][modes], of the first modes  @param scale  [sources][rows]
  Amplitudes(const WholeNumbers& Y, std::span<const float> scale, std::size_t rows, std::size_t modes)
      : Y_(Y), scale_(scale), rows_(rows), modes_(modes) {}

  /// y += factor * sum_r weight[r] * row r. @param weight  [rows]  @param y  [n], at least `modes`. Real-time: yes.
  void add(std::int32_t source, std::span<const double> weight, double factor,
           std::span<float> y) const noexcept PALPATE_NONBLOCKING;
  /// y += factor * one row. @param y  [n], at least `modes`
  void addRow(std::int32_t source, std::size_t row, double factor, std::span<float> y) const noexcept;
  /// Each row by itself: y += sum_i weight[i] * the rows of source[i]. @param y  [rows][n]. Real-time: yes.
  void addRows(std::span<const std::int32_t> source, const double* weight,
               std::span<float> y) const noexcept PALPATE_NONBLOCKING;
  /// kTogether of add() at once. @param weight  [rows][kTogether]  @param y  [kTogether][n]. Real-time: yes.
  void addTogether(std::int32_t source, std::span<const float> weight,
                   std::span<float> y) const noexcept PALPATE_NONBLOCKING;

 private:
  WholeNumbers Y_;
  std::span<const float> scale_;
  std::size_t rows_, modes_;
};

/// The modes, u(X) = sum_k X_k(X) y_k, m (docs/design.md, Reproduction, Parts). Linear in y: the y of several tools add up
/// before the one product with X. Modes are whole numbers over a scale each, node by node, so that one node's numbers lie
/// together; what they are multiplied with has the scales in it (weigh()). Borrows the model's arrays.
class SeparatedField {
 public:
  explicit SeparatedField(const ModelView& view);

  [[nodiscard]] int modes() const noexcept { return static_cast<int>(scale_.size()); }
  /// y_k *= scale_k. @param y  [n]. Real-time: yes.
  void weigh(std::span<float> y) const noexcept PALPATE_NONBLOCKING;
  /// u = X y, m. @param y  weigh()ed  @param u  [Ns][3]. Cost O(n Ns). Real-time: yes.
  void expand(std::span<const float> y, std::span<float> u) const noexcept PALPATE_NONBLOCKING;
  /// u of one surface node, m, as expand() gives it. @param y  weigh()ed. Cost O(n). Real-time: yes.
  [[nodiscard]] Vec3 at(std::span<const float> y, int node) const noexcept PALPATE_NONBLOCKING;
  /// x += weight X(node), without the scales. @param x  [3][n]. Cost O(n).
  void addNode(int node, float weight, std::span<float> x) const noexcept;
  /// kTogether sums over nodes at once: x[c] = sum_j weight[j][c] X(node[j]). @param x  [kTogether][3][n]. Real-time: yes.
  void average(std::span<const std::int32_t> node, std::span<const float> weight,
               std::span<float> x) const noexcept PALPATE_NONBLOCKING;

 private:
  WholeNumbers X_;                // [Ns][3][n]
  std::span<const float> scale_;  // [n]
};

/// Where nodes are, m. @param positions  [nodes of the surface][3] m
[[nodiscard]] std::vector<Vec3> pointsOf(std::span<const double> positions,
                                         std::span<const std::int32_t> nodes);

/// Surface nodes near something, for each source. Borrows.
struct NearNodes {
  std::span<const std::int64_t> offset;  ///< [sources + 1]
  std::span<const std::int32_t> node;    ///< [sum K], ascending for each source

  /// Of one source. Real-time: yes.
  [[nodiscard]] std::span<const std::int32_t> of(std::int32_t source) const noexcept PALPATE_NONBLOCKING;
  /// Which of all it is; -1 where the source has it not. Cost O(log K). Real-time: yes.
  [[nodiscard]] std::ptrdiff_t find(std::int32_t source,
                                    std::int32_t wanted) const noexcept PALPATE_NONBLOCKING;
  /// The most that a source has.
  [[nodiscard]] std::size_t most() const noexcept;
  /// The farthest of them from their source, m. @param source  [sources] m  @param positions  [Ns][3]
  [[nodiscard]] double reach(std::span<const Vec3> source, std::span<const double> positions) const;
};

/// A near field: what the modes miss close to each source, already windowed to zero at the near radius (docs/design.md, Parts).
/// Borrows.
class NearField {
 public:
  /// @param field  per source [rows][K][3]  @param scale  [sources][rows]
  NearField(const NearNodes& nodes, const WholeNumbers& field, std::span<const float> scale, std::size_t rows)
      : nodes_(nodes), field_(field), scale_(scale), rows_(rows), block_size_(3 * nodes.most()) {}

  /// The near block of one source; borrowed from the model and the scratch.
  struct Block {
    std::span<const std::int32_t> nodes;  ///< [K] surface nodes
    std::span<const float> u;             ///< [K][3] m
  };

  /// Surface nodes that a source's block moves. Real-time: yes.
  [[nodiscard]] std::span<const std::int32_t> nodes(std::int32_t source) const noexcept PALPATE_NONBLOCKING {
    return nodes_.of(source);
  }
  /// Numbers of scratch for a block: 3 * the largest K.
  [[nodiscard]] std::size_t blockSize() const noexcept { return block_size_; }
  /// factor * sum_r weight[r] * row r. @param weight  [rows]
  /// @param scratch  blockSize(), its beginning overwritten. Real-time: yes.
  [[nodiscard]] Block block(std::int32_t source, std::span<const double> weight, double factor,
                            std::span<float> scratch) const noexcept PALPATE_NONBLOCKING;
  /// What block() gives at one node, m; zero where the block has it not. Cost O(rows + log K). Real-time: yes.
  [[nodiscard]] Vec3 at(std::int32_t source, std::span<const double> weight,
                        std::int32_t node) const noexcept PALPATE_NONBLOCKING;
  /// Of each row by itself: u[r] += factor * row r at one node, m. @param u  [rows], or of the first. Cost O(rows + log K).
  void addRowsAt(std::int32_t source, double factor, std::int32_t node, std::span<Vec3> u) const noexcept;
  /// u += a block. @param scratch  blockSize(), @param u  [Ns][3]. Real-time: yes.
  void add(std::int32_t source, std::span<const double> weight, double factor, std::span<float> scratch,
           std::span<float> u) const noexcept PALPATE_NONBLOCKING;
  /// kTogether of block() at once: u[c] = sum_r weight[r][c] * row r. @param weight  [rows][kTogether], or of the first rows
  /// @param u  [kTogether][K][3], and a number behind that is set to zero; may be longer. Real-time: yes.
  void findTogether(std::int32_t source, std::span<const float> weight,
                    std::span<float> u) const noexcept PALPATE_NONBLOCKING;
  /// NearNodes::reach().
  [[nodiscard]] double reach(std::span<const Vec3> source, std::span<const double> positions) const {
    return nodes_.reach(source, positions);
  }

 private:
  /// Where the first row of a node's numbers is in field_, of a source that has the node as number `place` of all.
  [[nodiscard]] std::size_t numbersOf(std::int32_t source,
                                      std::ptrdiff_t place) const noexcept PALPATE_NONBLOCKING;

  NearNodes nodes_;
  WholeNumbers field_;
  std::span<const float> scale_;
  std::size_t rows_;
  std::size_t block_size_;
};

}  // namespace palpate
