// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/solver/base/ranks.h"

namespace palpate::solver {

/// A list of entries, numbered from 0, in blocks that do not depend on threads or ranks: what is added up block by block has the
/// same bits for any number of them. Each rank has a run of blocks. Their number is a multiple of four where there are enough
/// entries, so that two or four have as much to do.                                        docs/decisions/ranks.md
class Blocks {
 public:
  static constexpr std::size_t kMost = 64;  ///< entries of a block

  /// @param order  of the entries, each once, neighbours together
  /// @param part   entries that are worked on together: a block has whole parts  @param most  entries of a block, whole parts
  Blocks(std::vector<std::int32_t> order, std::size_t part, std::size_t most, const Ranks& ranks);
  /// Entries in the order of their numbers.
  Blocks(std::size_t entries, const Ranks& ranks = Ranks::one(), std::size_t part = 1);

  [[nodiscard]] const Ranks& ranks() const noexcept { return *ranks_; }
  [[nodiscard]] std::span<const std::int32_t> order() const noexcept { return order_; }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// Where a block begins in order(); count(): the end.
  [[nodiscard]] std::size_t begin(std::size_t block) const noexcept {
    return count_ == 0 ? 0 : std::min(part_ * (parts_ * block / count_), order_.size());
  }
  [[nodiscard]] std::span<const std::int32_t> block(std::size_t b) const noexcept {
    return order().subspan(begin(b), begin(b + 1) - begin(b));
  }
  /// The first block of a rank; size(): the end.
  [[nodiscard]] std::size_t firstOf(int rank) const noexcept {
    return count_ * static_cast<std::size_t>(rank) / static_cast<std::size_t>(ranks_->size());
  }
  [[nodiscard]] int rankOf(std::size_t block) const noexcept;
  /// What this rank has, as a part of order().
  [[nodiscard]] std::size_t ownBegin() const noexcept { return begin(firstOf(ranks_->rank())); }
  [[nodiscard]] std::size_t ownEnd() const noexcept { return begin(firstOf(ranks_->rank() + 1)); }

 private:
  std::vector<std::int32_t> order_;
  std::size_t part_, parts_, count_;
  const Ranks* ranks_;
};

/// What each rank has of its own entries goes to all.
/// @param piece  piece(entry): a span of numbers, as long on all ranks
template <class PieceOf>
void share(const Blocks& blocks, const PieceOf& piece) {
  using Span = decltype(piece(std::int32_t{0}));
  const Ranks& ranks = blocks.ranks();
  if (ranks.size() == 1) return;
  std::vector<typename Span::value_type> packed;
  for (std::size_t b = 0; b < blocks.count(); ++b) {
    const int from = blocks.rankOf(b);
    packed.clear();
    for (const std::int32_t entry : blocks.block(b)) {
      const Span own = piece(entry);
      packed.insert(packed.end(), own.begin(), own.end());
    }
    ranks.broadcast(std::as_writable_bytes(std::span(packed)), from);
    if (from == ranks.rank()) continue;
    auto next = packed.begin();
    for (const std::int32_t entry : blocks.block(b)) {
      const Span own = piece(entry);
      std::copy_n(next, own.size(), own.begin());
      next += static_cast<std::ptrdiff_t>(own.size());
    }
  }
}

/// The same for lists whose lengths only their rank knows.
/// @param list  list(entry): the vector of an entry
template <class ListOf>
void shareLists(const Blocks& blocks, const ListOf& list) {
  if (blocks.ranks().size() == 1) return;
  std::vector<std::uint64_t> lengths(blocks.order().size());
  for (const std::int32_t entry : blocks.order())
    lengths[static_cast<std::size_t>(entry)] = list(entry).size();
  share(blocks, [&](std::int32_t entry) { return std::span(&lengths[static_cast<std::size_t>(entry)], 1); });
  for (const std::int32_t entry : blocks.order())
    list(entry).resize(lengths[static_cast<std::size_t>(entry)]);
  share(blocks, [&](std::int32_t entry) { return std::span(list(entry)); });
}

}  // namespace palpate::solver
