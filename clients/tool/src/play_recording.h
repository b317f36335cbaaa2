// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "palpate/client/gap_counter.h"
#include "palpate/client/server_hold.h"
#include "palpate/idl/participant.h"
#include "palpate/idl/types.h"
#include "palpate/rt/cycle_stats.h"
#include "recorded_session.h"

namespace palpate::tool {

/// A recorded pose, and the first answer to it now.
struct ReplayedPose {
  const RecordedPose* recorded;
  dds::ToolForce now;
  /// No stall decides about one of the two forces (StallMemory).
  bool compared;

  [[nodiscard]] device::Point force() const noexcept;
  /// Size of the difference of the forces, N.
  [[nodiscard]] double difference() const noexcept;
};

/// One tool of a session, played back.
struct ReplayedTool {
  std::uint32_t recorded_as{0};
  std::uint32_t sent_as{0};
  std::uint64_t sent{0};
  std::uint64_t superseded{0};  ///< by the server's count, from the first answer to the last
  client::GapCounter answers;
  std::vector<ReplayedPose> poses;  ///< those that were answered, in their order

  /// Largest size of a force among those that are compared, N.
  [[nodiscard]] double largestRecorded() const noexcept;
  [[nodiscard]] double largestNow() const noexcept;
  [[nodiscard]] std::uint64_t compared() const noexcept;
  /// The pose whose forces differ most; nothing where none is compared.
  [[nodiscard]] const ReplayedPose* worst() const noexcept;
  /// Whether no force differs by more than this share of the largest recorded one. False where the answers to less than half of
  /// the poses that were sent can be compared.
  [[nodiscard]] bool within(double share) const noexcept;
};

/// Whether a stall decides about the force. A server fades it where poses stopped, and blends it after it stood still itself for
/// long. After that the contact may be another one, until nothing presses on the tool, or it slid for some time, or both contacts
/// hold the same point of the organ again. A short stall is
/// felt by the coupling's damper only.
class StallMemory {
 public:
  /// @param[in] letting_go  one of the two forces fades  @param[in] skipped  poses between this one and the last that was answered
  /// @param[in] recorded, now  answers to the same pose, in their order
  /// @return whether it does
  bool add(bool letting_go, std::uint64_t skipped, const RecordedPose& recorded,
           const dds::ToolForce& now) noexcept;

 private:
  bool on_{false};
  int slid_{0}, same_{0};          // answers in a row
  std::int64_t jolt_until_ns_{0};  // of a short stall, on the session's clock
};

/// A session that was played back.
struct Playback {
  std::vector<ReplayedTool> tools;
  rt::CycleStats lateness;  ///< of sending each pose, ns
  std::uint64_t left_out{0};
  std::string left_out_text;  ///< forces of other servers; empty: none
  bool realtime{false};
  bool server_left{false};         ///< the server said that it shuts down
  bool interrupted{false};         ///< by a stop signal
  std::uint64_t model_changes{0};  ///< how often the server took another model

  /// Whether one organ answered the session from its beginning to its end.
  [[nodiscard]] bool isWhole() const noexcept { return !server_left && !interrupted && model_changes == 0; }
};

/// Sends the session's poses to a server at their own times, from one thread, with new numbers and stamps, and keeps the first
/// answer to each. Ends early on a stop signal or when the server leaves.
/// @param[in] session  outlives the result  @param[in] as  tool id to send as; nothing: as recorded
/// @throw client::ClientError  no server takes poses, or none answers
[[nodiscard]] Playback playRecording(const dds::Participant& participant, const RecordedSession& session,
                                     std::optional<std::uint32_t> as, const client::ServerRun& server);

}  // namespace palpate::tool
