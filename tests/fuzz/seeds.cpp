// SPDX-License-Identifier: Apache-2.0
// Writes the seeds of corpus/ that no editor writes: build/release/bin/fuzz_seeds tests/fuzz/corpus
#include <cstdio>
#include <filesystem>

#include "core/record/record_writer.h"
#include "tools/solver/base/journal.h"

namespace {

using namespace palpate;

// Two tools for a while: one stays, one comes and goes, and settings change.
void writeRecording(const std::filesystem::path& file, std::uint64_t ticks) {
  record::RecordWriter writer(file, {});
  for (std::uint64_t i = 0; i < ticks; ++i) {
    record::RecordedTick tick;
    tick.index = 2 * i;
    tick.input.dt_ns = 1'000'000;
    tick.input.period_ns = 1'000'000;
    tick.woke_ns = static_cast<std::int64_t>(1'000'000 * i + (i == 2 ? 7 : 0));
    tick.input.tools[0].present = 1;
    tick.input.tools[1].present = i % 2 == 0 ? 1 : 0;
    tick.input.tools[1].position = {0.0, 0.0, 0.001 * static_cast<double>(i)};
    tick.input.has_settings = i == 1 ? 1 : 0;
    tick.input.field_overflowed = i == 3 ? 1 : 0;
    tick.result.tools[0].force = {0.0, 0.0, 0.1 * static_cast<double>(i / 2)};
    tick.poses[0].seq = i;
    writer.write(tick);
    if (i == 1) writer.flush();
  }
  writer.finish(2 * ticks);
}

void writeJournal(const std::filesystem::path& file) {
  std::filesystem::remove(file);
  solver::Journal journal(file);
  record::Bytes bytes;
  solver::putArray(bytes, std::vector<double>{1.0, 2.0});
  solver::putArray(bytes, std::vector<double>{});
  journal.keep(0, bytes, 0.5);
  journal.keep(2, {}, 0.5);
  journal.keep(1, {1, 2, 3}, 0.5);
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "Usage: fuzz_seeds CORPUS\n");
    return 2;
  }
  const std::filesystem::path corpus(words[1]);
  for (const char* name : {"recording", "journal"}) std::filesystem::create_directories(corpus / name);
  writeRecording(corpus / "recording" / "no_ticks", 0);
  writeRecording(corpus / "recording" / "six_ticks", 6);
  writeJournal(corpus / "journal" / "three_parts");
}
