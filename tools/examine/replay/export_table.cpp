// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/replay/export_table.h"

#include <array>
#include <optional>

#include "tools/examine/replay/table_writer.h"

namespace palpate::replay {

TableSize exportTable(record::RecordReader& recording, const std::string& format,
                      const std::filesystem::path& path, Demand demand) {
  const auto writer = format == "csv" ? csvWriter(path) : h5Writer(path, recording.facts());
  TableSize size;
  std::array<record::PoseFacts, kMaxTools> known{};
  std::optional<std::int64_t> start_ns;
  std::uint64_t expected = 0;
  for (record::RecordedTick tick; nextTick(recording, demand, tick, size.truncated); ++size.ticks) {
    noteGap(expected, tick.index, demand, size.missing);
    expected = tick.index + 1;
    if (!start_ns) start_ns = tick.woke_ns;
    for (std::size_t tool = 0; tool < known.size(); ++tool) {
      if (tick.input.tools[tool].present == 0) continue;
      writer->add({tick, tool, *start_ns, tick.poses[tool] != known[tool]});
      known[tool] = tick.poses[tool];
      ++size.rows;
    }
  }
  noteEnd(recording, demand, size.truncated, size.missing);
  writer->finish();
  return size;
}

}  // namespace palpate::replay
