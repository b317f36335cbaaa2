// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace palpate::solver {

/// The processes that solve together; this class by itself is the only one. All ranks call what moves data, in the same order, each
/// from the thread that began the solve.                                                 docs/decisions/ranks.md
class Ranks {
 public:
  Ranks() = default;
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  /// Of this process, from 0.
  [[nodiscard]] virtual int rank() const noexcept { return 0; }
  [[nodiscard]] virtual int size() const noexcept { return 1; }
  /// Ranks of this one's machine, itself included: they share its memory.
  [[nodiscard]] virtual int onMachine() const noexcept { return 1; }
  /// What one rank has goes to all. @param data  as long on all
  virtual void broadcast(std::span<std::byte> data, int from) const;
  /// What one rank has goes to another one; the others do nothing. @param data  as long on both
  virtual void move(std::span<std::byte> data, int from, int to) const;

  /// Whether all ranks say yes; the same on each. Also waits for the last one.
  [[nodiscard]] bool all(bool own) const;

  [[nodiscard]] bool isFirst() const noexcept { return rank() == 0; }
  [[nodiscard]] static const Ranks& one();
};

}  // namespace palpate::solver
