// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "tools/solver/base/blocks.h"

namespace palpate::solver {

/// Where a scratch file is.
struct ScratchPlace {
  std::filesystem::path folder;
  std::string
      name{};  ///< empty: the file loses its name at once, so the system removes it however the program ends
  ScratchPlace(std::filesystem::path in) : folder(std::move(in)) {}
  ScratchPlace(std::filesystem::path in, std::string named) : folder(std::move(in)), name(std::move(named)) {}
};

/// The fields of the contact positions of this rank, [position][coefficient][row] in float32, in a scratch file: memory
/// never holds the whole table. They lie there in the order of their blocks. Threads: any number may read and write different positions.
class FieldTable {
 public:
  /// @throw std::runtime_error when the disk has no room for it
  FieldTable(const ScratchPlace& place, Blocks positions, std::size_t coefficients, std::size_t rows);
  ~FieldTable();
  FieldTable(const FieldTable&) = delete;
  FieldTable& operator=(const FieldTable&) = delete;

  /// The positions of all ranks.
  [[nodiscard]] const Blocks& blocks() const noexcept { return blocks_; }
  [[nodiscard]] std::size_t positions() const noexcept { return blocks_.order().size(); }
  [[nodiscard]] std::size_t coefficients() const noexcept { return coefficients_; }
  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }

  /// @param position  of this rank  @param fields  coefficients x rows numbers
  void write(std::size_t position, std::span<const float> fields);
  /// @param position  of this rank  @param[out] fields  coefficients x rows numbers
  void read(std::size_t position, std::span<float> fields) const;
  /// CRC-32 of some fields, for a journal to know them by.
  [[nodiscard]] static std::uint32_t checksum(std::span<const float> fields) noexcept;
  /// Of what a position has. @param room  for the position's fields
  [[nodiscard]] std::uint32_t checksum(std::size_t position, std::vector<float>& room) const;

 private:
  [[nodiscard]] std::size_t blockBytes() const noexcept { return coefficients_ * rows_ * sizeof(float); }

  /// @throw std::out_of_range  a position of another rank
  [[nodiscard]] std::size_t offsetOf(std::size_t position) const { return slot_.at(position) * blockBytes(); }

  int file_{-1};
  Blocks blocks_;
  std::unordered_map<std::size_t, std::size_t> slot_;  ///< in the file, of the positions of this rank
  std::size_t coefficients_, rows_;
};

}  // namespace palpate::solver
