// SPDX-License-Identifier: Apache-2.0
#include "recorded.h"

#include "core/record/record_reader.h"

namespace palpate::faults {

Recorded read(const std::filesystem::path& path) {
  record::RecordReader reader(path);
  record::RecordedTick tick;
  Recorded recorded;
  std::uint64_t next = 0;
  try {
    for (; reader.next(tick); next = tick.index + 1) {
      recorded.gaps += tick.index - next;
      ++recorded.ticks;
      recorded.last_woke_ns = tick.woke_ns;
    }
    recorded.ended = true;
    recorded.missing = reader.end().missing;
  } catch (const record::TruncatedError&) {
  }
  return recorded;
}

}  // namespace palpate::faults
