// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <istream>
#include <memory>
#include <optional>
#include <vector>

#include "core/record/recording.h"

namespace palpate::record {

class TickCodec;

/// Reads a session, tick by tick, and believes nothing: each block's checksum, each size, the order of the ticks and
/// their number at the end are checked. Threads: one. Real-time: no.
class RecordReader {
 public:
  /// @throw RecordError  no such file, no recording of ours, another version, damaged header
  explicit RecordReader(const std::filesystem::path& path);
  /// The same of a stream. @param[in] path  how it is called in messages
  RecordReader(const std::filesystem::path& path, std::unique_ptr<std::istream> file);
  ~RecordReader();
  RecordReader(const RecordReader&) = delete;
  RecordReader& operator=(const RecordReader&) = delete;

  [[nodiscard]] const SessionFacts& facts() const noexcept { return facts_; }

  /// The next tick. @return false at the end, which then is known
  /// @throw RecordError "FILE: at byte N: ..." for damage; "FILE: truncated at byte N ..." where the end is missing
  [[nodiscard]] bool next(RecordedTick& tick);

  /// After next() returned false.
  [[nodiscard]] const SessionEnd& end() const noexcept { return end_; }
  /// Ticks read so far.
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_; }

 private:
  class Block;

  void readFacts();
  [[nodiscard]] std::uint32_t readBlock();
  void readEnd();
  void read(void* to, std::size_t size);
  [[noreturn]] void refuse(const std::string& text) const;
  [[noreturn]] void refuseTruncated() const;

  std::filesystem::path path_;
  std::unique_ptr<std::istream> file_;
  std::uint64_t offset_{0};       // of the next byte of the file
  std::uint64_t block_begin_{0};  // of the block that is being read
  SessionFacts facts_;
  std::unique_ptr<TickCodec> codec_;
  std::unique_ptr<Block> block_;
  std::optional<std::uint64_t> last_index_;
  std::uint64_t ticks_{0};
  SessionEnd end_;
};

}  // namespace palpate::record
