// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/record/record_writer.h"
#include "palpate/server/channels.h"

namespace palpate::server {

/// Writes every tick's input and result to a file, on a thread of its own: the tick only fills a ring.
class Recorder {
 public:
  /// Creates the file and the ring. Before the tick starts. @throw record::RecordError
  Recorder(Channels& channels, const std::filesystem::path& path, const record::SessionFacts& facts);

  /// Body of the recorder thread. Returns once the server stops, the ring is empty and the file has its end.
  void run() noexcept;

  /// One line for the log, after run() has returned.
  [[nodiscard]] std::string summary() const;

 private:
  void drain();

  Channels& channels_;
  std::filesystem::path path_;
  record::RecordWriter writer_;
  std::string failure_;  // why the file ends early; empty: it does not
};

}  // namespace palpate::server
