// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace palpate::solver {

/// The fields of all contact positions, [position][coefficient][row] in float32, in a scratch file: memory
/// never holds the whole table. The file loses its name once it is open, so the system removes it however the
/// program ends. Threads: any number may read and write different positions.
class FieldTable {
 public:
  /// @param folder  where the scratch file lives  @throw std::runtime_error when the disk has no room for it
  FieldTable(const std::filesystem::path& folder, std::size_t positions, std::size_t coefficients,
             std::size_t rows);
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

 private:
  [[nodiscard]] std::size_t blockBytes() const noexcept { return coefficients_ * rows_ * sizeof(float); }

  int file_{-1};
  std::size_t positions_, coefficients_, rows_;
};

}  // namespace palpate::solver
