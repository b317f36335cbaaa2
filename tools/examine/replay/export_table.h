// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/record/record_reader.h"
#include "tools/examine/replay/replay.h"

namespace palpate::replay {

/// What was written.
struct TableSize {
  std::uint64_t rows{0};
  std::uint64_t ticks{0};
  std::uint64_t missing{0};  ///< ticks that the session ran and the file does not hold, as far as it tells
  bool truncated{false};     ///< the recording has no end
};

/// Writes poses and forces of a recording as a table, one row for each tick and tool that is there, the columns of
/// table_columns.h. Another version's answers are written as they are. The file takes its place when it is whole.
/// @param[in] format  "csv": RFC 4180 with a line of names; "h5": HDF5, one dataset a column with the attributes unit and
///                    description, and of the root model_id, engine, started_ns
/// @throw record::RecordError  damaged; under kWhole also a missing tick or end. program::WriteError
TableSize exportTable(record::RecordReader& recording, const std::string& format,
                      const std::filesystem::path& path, Demand demand);

}  // namespace palpate::replay
