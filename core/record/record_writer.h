// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/record/recording.h"

namespace palpate::record {

class TickCodec;

/// Writes a session, tick by tick. Threads: one at a time. Real-time: no.
class RecordWriter {
 public:
  /// Creates the file, or empties it, and writes what the session runs on. @throw RecordError naming file and reason
  RecordWriter(const std::filesystem::path& path, const SessionFacts& facts);
  ~RecordWriter();
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  /// Ticks come with rising index; gaps are allowed, and counted. @throw RecordError, e.g. when the disk is full
  void write(const RecordedTick& tick);
  /// Writes what is still held back to the file, so that it survives us. @throw RecordError
  void flush();
  /// Ends the recording; without it a reader calls it truncated. @param[in] ticks_run  by the server, >= those written
  /// @throw RecordError
  void finish(std::uint64_t ticks_run);

  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };

  void writeBlock(std::uint32_t kind, const std::vector<std::uint8_t>& content);
  void writeAll(const void* data, std::size_t size);

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::unique_ptr<TickCodec> codec_;
  std::vector<std::uint8_t> pending_;
  std::uint64_t ticks_{0};
};

}  // namespace palpate::record
