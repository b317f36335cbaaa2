// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "core/record/recording.h"
#include "tools/examine/replay/table_columns.h"

namespace palpate::replay {

/// Takes the rows of a table, one after the other. Threads: one.
class TableWriter {
 public:
  TableWriter() = default;
  virtual ~TableWriter() = default;
  TableWriter(const TableWriter&) = delete;
  TableWriter& operator=(const TableWriter&) = delete;

  /// @throw program::WriteError
  virtual void add(const TableRow& row) = 0;
  /// Once, after the last row: the file is whole and takes its place. @throw program::WriteError
  virtual void finish() = 0;
};

/// Both write beside the target. @throw program::WriteError
[[nodiscard]] std::unique_ptr<TableWriter> csvWriter(const std::filesystem::path& path);
[[nodiscard]] std::unique_ptr<TableWriter> h5Writer(const std::filesystem::path& path,
                                                    const record::SessionFacts& facts);

}  // namespace palpate::replay
