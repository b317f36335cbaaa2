// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "page_message.h"
#include "page_text.h"
#include "palpate/client/frame_pace.h"
#include "palpate/rt/token_bucket.h"
#include "viewer.h"

namespace palpate::viewer {

/// WebSocket close codes that a page may get (RFC 6455, 7.4.1).
enum class Close : std::uint16_t { kNone = 0, kNotText = 1003, kPolicy = 1008, kTooLarge = 1009 };

/// One page: what it has, and what it gets next. It has no queue: each message is made from the newest data when the socket
/// takes it. At most kInFlight frames are unacknowledged. Threads: the web thread.
class Page final : public PageListener {
 public:
  static constexpr std::uint32_t kInFlight = 2;
  static constexpr double kMessagesPerSecond = 400.0;
  static constexpr double kPartsPerSecond = 1600.0;         ///< parts of messages
  static constexpr std::size_t kMostAnswers = 256;          ///< per frame
  static constexpr std::int64_t kStatusNs = 1'000'000'000;  ///< between statuses when nothing changes
  static constexpr std::int64_t kLeastStatusNs = 100'000'000;

  Page(std::uint64_t id, Viewer& viewer, double max_rate_hz);
  ~Page() override;

  /// A part of a text message came. @param[in] last  completes the message
  /// @return kNone, or the reason to close the page
  [[nodiscard]] Close receive(std::string_view part, bool first, bool last, bool binary, std::int64_t now_ns);

  /// Whether next() has a message.
  [[nodiscard]] bool wants(std::int64_t now_ns) const;

  /// Appends the next message. @return whether it is binary; nothing without a message
  [[nodiscard]] std::optional<bool> next(std::int64_t now_ns, Bytes& out);

  void toolEnded(const std::string& message) override { grant_ = ToolGrant{false, 0, message}; }
  void answered(const ParameterDesk::Answer& answer) override;
  /// Tells the page when another program sends the tool that it drives.
  void lookForRival(std::int64_t now_ns) override;

  [[nodiscard]] std::uint64_t id() const noexcept override { return id_; }

 private:
  [[nodiscard]] Close act(const PageMessage& message);
  [[nodiscard]] std::optional<std::string> nextText(std::int64_t now_ns);
  [[nodiscard]] bool meshDue() const;
  [[nodiscard]] bool statusDue(std::int64_t now_ns) const;
  [[nodiscard]] bool frameDue(std::int64_t now_ns) const;
  void frame(std::int64_t now_ns, Bytes& out);
  [[nodiscard]] std::vector<ToolRecord> tools(std::int64_t now_ns) const;
  [[nodiscard]] std::uint32_t shownTools(std::int64_t now_ns) const;

  std::uint64_t id_;
  Viewer& viewer_;
  double max_rate_hz_;
  client::FramePace pace_;
  rt::TokenBucket messages_{kMessagesPerSecond, kMessagesPerSecond};
  rt::TokenBucket parts_{kPartsPerSecond, kPartsPerSecond};
  std::string incoming_;

  bool hello_{true};  // messages to send
  std::uint64_t state_version_{0};
  std::uint32_t mesh_text_revision_{0};
  std::uint32_t mesh_revision_{0};
  std::uint64_t status_version_{0};
  std::int64_t status_ns_{0};
  std::optional<ToolGrant> grant_;
  bool rival_told_{false};
  std::deque<ParameterDesk::Answer> answers_;
  std::optional<double> ping_;

  std::uint32_t sent_{0};  // frames
  std::uint32_t acked_{0};
  std::uint32_t counted_{0};  // frames at the last status
  std::uint64_t field_version_{0};
  std::uint64_t answer_place_;
  std::uint32_t shown_{0};  // tools in the newest frame, bit by id
  std::vector<AnswerRecord> batch_;
};

}  // namespace palpate::viewer
