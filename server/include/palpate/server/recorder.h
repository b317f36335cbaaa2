// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "core/record/record_writer.h"
#include "palpate/server/channels.h"

namespace palpate::server {

/// What a recording says of its session. @param config  that the engine began with
[[nodiscard]] record::SessionFacts sessionOf(const MetaModel& model, const StepConfig& config);

/// Writes every tick's input and result to a file, on a thread of its own: the tick only fills a ring. A session that goes on with
/// another model goes on in another file, "session-2.rec" after "session.rec": a recording is of one model.
class Recorder {
 public:
  static constexpr int kMostFiles =
      1000;  ///< of a session; their numbers are higher where files of an earlier one are there

  /// Creates the file and the ring. Before the tick starts. @throw record::RecordError
  Recorder(Channels& channels, const std::filesystem::path& path, const record::SessionFacts& facts);

  /// Another engine may follow. Before the tick runs it. Threads: any but the tick; takes a lock. Real-time: no.
  /// @param[in] engine  its number
  /// @return the file that its ticks will go to; none that is there is overwritten, since it is a client that asked for the model
  /// @throw record::RecordError  kMostFiles are there: clients that ask for models do not fill the folder
  std::filesystem::path expect(std::uint64_t engine, const record::SessionFacts& facts);

  /// Body of the recorder thread. Returns once the server stops, the ring is empty and the file has its end.
  void run() noexcept;

  /// One line for the log, after run() has returned.
  [[nodiscard]] std::string summary() const;

 private:
  void drain();
  void goOn(const SessionTick& first);
  void finish(std::uint64_t unrecorded);

  Channels& channels_;
  std::filesystem::path first_path_;
  std::filesystem::path path_;
  std::optional<record::RecordWriter> writer_;
  std::uint64_t engine_{0};      // whose ticks are in the file
  std::uint64_t unrecorded_{0};  // when the file began
  std::string finished_;         // what there is to say of the files before
  std::mutex mutex_;             // the next
  struct Next {
    std::filesystem::path path;
    record::SessionFacts facts;
  };
  std::map<std::uint64_t, Next> expected_;  // by engine
  int number_{1};                           // expect()'s: in the name of the newest file
  int files_{1};                            // expect()'s: of this session
  std::string failure_;                     // why the file ends early; empty: it does not
};

}  // namespace palpate::server
