// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/devices/path/pose_follower.h"
#include "outward.h"
#include "page_text.h"
#include "palpate/idl/writer.h"

namespace palpate::viewer {

/// Tools that pages drive. Gives a page a free tool id on request and publishes its poses at 1 kHz, on its own thread, which
/// waits while no tool is driven. Threads: the web thread calls. The lock is held for microseconds, never while a pose is
/// written.
class ToolDesk {
 public:
  static constexpr std::size_t kTools = 4;  ///< palpate.idl: tool_id 0 .. 3
  /// A tool belongs to another program for this long after that program's last pose.
  static constexpr std::int64_t kTakenNs = 500'000'000;
  /// A tool rests this long after its last pose, so that its force is zero at the server (zero_after, 50 ms).
  static constexpr std::int64_t kRestNs = 120'000'000;
  static constexpr double kMaxSpeed = 0.6;  ///< m/s, and at most half of the server's speed limit

  /// One run of a server.
  struct Server {
    std::uint64_t session;
    std::uint32_t server_id;  ///< whose poses these are
    std::uint32_t tools;      ///< 0 .. tools - 1 are answered
    double speed_limit;       ///< m/s; 0: none
  };

  /// A page lost its tool, and why.
  struct Ending {
    std::uint64_t page_id;
    std::string message;
  };

  /// @param[in] ids  tools that pages may drive, in the order of preference
  /// A participant whose role may not write poses gives no page a tool. @throw dds::DdsError
  ToolDesk(const dds::Participant& participant, std::vector<std::uint32_t> ids);
  ~ToolDesk();
  ToolDesk(const ToolDesk&) = delete;
  ToolDesk& operator=(const ToolDesk&) = delete;

  /// The server that answers tools. Tools of the one before end. Without one, no page gets a tool.
  void setServer(const Server& server);
  void setNoServer() { server_tools_ = 0; }
  void setSurface(const client::Surface& surface) { outward_ = Outward(surface); }
  /// What pages hold ends: a hand that pressed one organ should not press the next by surprise. @param message  why
  void endAll(const char* message);
  /// A pose of this tool came over the wire from another program.
  void sawForeignPose(std::uint32_t tool_id, std::int64_t now_ns) noexcept;

  /// Drops the page's pending endings: this answer is newer.
  [[nodiscard]] ToolGrant grab(std::uint64_t page_id);
  /// @return false when the page has no tool
  bool target(std::uint64_t page_id, const device::Point& p_WT);
  /// The tool lifts off the organ; its id is free afterwards.
  void release(std::uint64_t page_id);
  /// The page is gone: its tool stops where it is, and the server fades the force to zero.
  void drop(std::uint64_t page_id);

  /// Tools that ended since the last call.
  [[nodiscard]] std::vector<Ending> endings();

  [[nodiscard]] std::optional<std::uint32_t> toolOf(std::uint64_t page_id) const;
  /// The newest published position of a tool that a page drives.
  [[nodiscard]] std::optional<device::Point> tipOf(std::uint32_t tool_id) const;
  /// The writer of this program's poses on the wire.
  [[nodiscard]] dds_instance_handle_t writerId() const noexcept;

 private:
  struct Driven {
    std::uint64_t page_id;
    device::PoseFollower follower;
  };
  struct Tool {
    std::optional<Driven> driven;
    std::uint64_t seq{0};
    std::int64_t foreign_ns{0};  // when another program's pose came last
    std::int64_t rests_ns{0};    // when it may be given again
  };

  void run();
  void stepAll(std::int64_t now_ns, std::vector<dds::ToolPose>& poses);
  void end(Tool& tool, const char* message, std::int64_t now_ns);
  static void rest(Tool& tool, std::int64_t now_ns);
  [[nodiscard]] Tool* find(std::uint64_t page_id);
  [[nodiscard]] bool anyDriven() const;

  std::vector<std::uint32_t> ids_;
  std::uint32_t server_tools_{0};  // web thread's, like session_, outward_ and speed_
  std::uint64_t session_{0};
  double speed_{kMaxSpeed};
  Outward outward_;
  std::optional<dds::Writer<dds::ToolPose>> writer_;  // where the identity may
  mutable std::mutex mutex_;                          // what is below
  std::condition_variable driven_;
  std::uint32_t server_id_{dds::kServerAny};
  std::array<Tool, kTools> tools_;
  std::vector<Ending> endings_;
  bool stop_{false};
  std::thread thread_;
};

}  // namespace palpate::viewer
