// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate::solver {

/// Where a scratch file is.
struct ScratchPlace {
  std::filesystem::path folder;
  std::string
      name{};  ///< empty: the file loses its name at once, so the system removes it however the program ends
  ScratchPlace(std::filesystem::path in) : folder(std::move(in)) {}
  ScratchPlace(std::filesystem::path in, std::string named) : folder(std::move(in)), name(std::move(named)) {}
};

/// The fields of all contact positions, [position][coefficient][row] in float32, in a scratch file: memory
/// never holds the whole table. Threads: any number may read and write different positions.
class FieldTable {
 public:
  /// @throw std::runtime_error when the disk has no room for it
  FieldTable(const ScratchPlace& place, std::size_t positions, std::size_t coefficients, std::size_t rows);
  ~FieldTable();
  FieldTable(const FieldTable&) = delete;
  FieldTable& operator=(const FieldTable&) = delete;

  [[nodiscard]] std::size_t positions() const noexcept { return positions_; }
  [[nodiscard]] std::size_t coefficients() const noexcept { return coefficients_; }
  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }

  /// @param fields  coefficients x rows numbers of one position
  void write(std::size_t position, std::span<const float> fields);
  /// @param[out] fields  coefficients x rows numbers of one position
  void read(std::size_t position, std::span<float> fields) const;
  /// CRC-32 of some fields, for a journal to know them by.
  [[nodiscard]] static std::uint32_t checksum(std::span<const float> fields) noexcept;
  /// Of what a position has. @param room  for the position's fields
  [[nodiscard]] std::uint32_t checksum(std::size_t position, std::vector<float>& room) const;

 private:
  [[nodiscard]] std::size_t blockBytes() const noexcept { return coefficients_ * rows_ * sizeof(float); }

  int file_{-1};
  std::size_t positions_, coefficients_, rows_;
};

}  // namespace palpate::solver
