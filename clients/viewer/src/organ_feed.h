// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "answer_log.h"
#include "arrivals.h"
#include "frame.h"
#include "outward.h"
#include "palpate/client/status_board.h"
#include "palpate/idl/reader.h"
#include "server_watch.h"
#include "surfaces.h"

namespace palpate::viewer {

/// What comes over DDS for the pages: the newest surface, field, status and parameters, and every answer. It outlives
/// servers and follows the next one; nothing of one that is not followed is shown. Threads: one, the web thread.
class OrganFeed {
 public:
  static constexpr std::size_t kTools = 4;
  static constexpr std::int64_t kToolShownNs = 500'000'000;  ///< after its last answer

  /// A tool in the server's last answer to it.
  struct ToolView {
    dds::ToolForce force{};
    std::int64_t received_ns{0};  ///< 0: never
    device::Point normal{};       ///< outward, at the anchor
    device::Point tip{};          ///< newest pose on the wire
    bool tip_known{false};
  };

  /// @param[in] wake  called on DDS's thread when a field comes
  /// @param[in] wanted  servers that may be followed  @throw dds::DdsError
  OrganFeed(const dds::Participant& participant, const client::WantedServer& wanted, double rate_hz,
            WakeFunction wake, void* context);

  /// Takes in what came. @param[in] own_writer  writer of this program's poses
  /// @return tools for which other programs sent poses
  std::vector<std::uint32_t> poll(std::int64_t now_ns, dds::WriterId own_writer);

  /// Without a page that watches, few fields are taken.
  void setWatched(bool watched) noexcept { arrivals_.setRate(watched ? rate_hz_ : 1.0); }

  [[nodiscard]] const ServerWatch& watch() const noexcept { return watch_; }
  /// Parameters of the followed server; nothing before it has sent them.
  [[nodiscard]] std::optional<dds::ServerParameters> parameters() const;
  [[nodiscard]] ServerState state(std::int64_t now_ns) const;
  /// Rises when a status of the followed server, or any parameters, come.
  [[nodiscard]] std::uint64_t statusVersion() const noexcept { return status_version_; }

  /// The surface shown; nullptr and revision 0 before the first. The revision rises with each new surface.
  [[nodiscard]] const client::Surface* surface() const noexcept {
    return revision_ == 0 ? nullptr : &surface_;
  }
  [[nodiscard]] std::uint32_t revision() const noexcept { return revision_; }
  [[nodiscard]] const Outward& outward() const noexcept { return outward_; }
  /// The newest field that fits the surface; nullptr before the first.
  [[nodiscard]] const EncodedField* field() const noexcept { return has_field_ ? &field_ : nullptr; }
  /// Rises with each field.
  [[nodiscard]] std::uint64_t fieldVersion() const noexcept { return field_version_; }
  [[nodiscard]] std::uint64_t droppedFields() const noexcept { return dropped_fields_; }

  [[nodiscard]] const AnswerLog& answers() const noexcept { return answers_; }
  /// nullptr when the server does not answer this tool, or answers only that its poses stopped.
  [[nodiscard]] const ToolView* tool(std::uint32_t id, std::int64_t now_ns) const noexcept;
  /// Servers' answers on topic `parameters` since the last call.
  [[nodiscard]] std::vector<dds::ServerParameters> newParameters() {
    return std::exchange(new_parameters_, {});
  }

 private:
  void lookForMismatch(std::int64_t now_ns);
  void pollServer(std::int64_t now_ns);
  void follow(std::uint64_t session);
  void keepParameters(const dds::ServerParameters& parameters);
  void selectSurface();
  void pollField();
  void pollForces();
  [[nodiscard]] std::vector<std::uint32_t> pollPoses(dds::WriterId own_writer);
  void addAnswer(const TimedForce& timed);
  [[nodiscard]] bool fits(const ArrivedField& field) const;
  [[nodiscard]] bool addressesFollowed(const dds::ToolPose& pose) const noexcept;
  static bool admitsPose(const dds::ToolPose& pose, void* context) noexcept;
  [[nodiscard]] const client::Surface* followedSurface() const;

  double rate_hz_;
  ServerWatch watch_;
  std::string mismatch_;  // newest reason why a server's endpoint does not match ours
  std::int64_t looked_ns_{0};
  std::map<std::uint64_t, dds::ServerParameters> parameters_;  // by session
  std::vector<dds::ServerParameters> new_parameters_;
  std::uint64_t status_version_{0};
  client::Surface surface_;
  std::uint32_t revision_{0};
  Outward outward_;
  EncodedField field_;
  bool has_field_{false};
  std::uint64_t field_version_{0};
  std::uint64_t dropped_fields_{0};
  ArrivedField arrived_;
  std::vector<TimedForce> forces_;
  std::array<ToolView, kTools> tools_{};
  AnswerLog answers_;
  StampClock stamp_clock_;
  client::StatusBoard statuses_;
  std::int64_t heard_ns_{0};  // the newest status that was looked at
  dds::Reader<dds::ServerParameters> parameter_answers_;
  Surfaces surfaces_;
  std::atomic<std::uint32_t> followed_id_{dds::kServerAny};  // poll() -> admitsPose(); relaxed, like the next
  std::atomic<bool> followed_answers_any_{false};
  dds::Reader<dds::ToolPose> poses_;
  Arrivals arrivals_;  // last: its callbacks stop first
};

}  // namespace palpate::viewer
