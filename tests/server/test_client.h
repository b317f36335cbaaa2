// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"

namespace palpate::server::testing {

using Point = std::array<double, 3>;

[[nodiscard]] inline double dot(const Point& a, const double (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline Point along(const Point& from, const Point& direction, double length) {
  return {from[0] + length * direction[0], from[1] + length * direction[1], from[2] + length * direction[2]};
}

/// A place on the organ that may be touched, found from what the server publishes.
struct Target {
  Point position{};  ///< accessible node that lies most toward +z, m
  Point normal{};    ///< outward, unit
  std::size_t nodes{0};
};

/// What a haptic device's driver does, with a memory: sends poses of one tool at 1 kHz, keeps every answer.
class TestClient {
 public:
  TestClient(std::uint32_t domain, std::uint32_t tool_id, std::optional<dds::Identity> identity = {});
  ~TestClient();

  /// Waits for the server's surface. @return nothing when none came within 20 s
  [[nodiscard]] std::optional<Target> findTarget();
  /// Waits until both topics have found the server.
  [[nodiscard]] bool connect();

  void startSending(const Point& position);
  void stopSending();
  /// From where it is to `position` in a straight line, at a constant speed. Returns when it is there.
  void moveTo(const Point& position, int milliseconds);
  /// One pose as it is; seq and stamp are filled in when zero.
  void send(dds::ToolPose pose);
  /// seq of the last pose that this client numbered.
  [[nodiscard]] std::uint64_t sent() const { return seq_; }
  [[nodiscard]] dds::ToolPose poseAt(const Point& position) const;

  [[nodiscard]] std::vector<dds::ToolForce> forces() const;
  [[nodiscard]] std::vector<dds::ToolForce> forcesOfOtherTools() const;
  void forget();
  /// Says something of the device; the server hears it as from the sender of the poses.
  void announce(const dds::ToolAnnouncement& said) {
    (void)announcements_.waitForReaders(1, std::chrono::seconds(5));
    (void)announcements_.write(said);
  }
  /// Waits until an answer satisfies `wanted`, for at most 10 s. @return that answer
  template <class Wanted>
  [[nodiscard]] std::optional<dds::ToolForce> waitFor(Wanted wanted) const {
    for (int i = 0; i < 2000; ++i) {
      for (const dds::ToolForce& force : forces()) {
        if (wanted(force)) return force;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return std::nullopt;
  }
  /// Newest status that satisfies `wanted`, within 10 s.
  template <class Wanted>
  [[nodiscard]] std::optional<dds::ServerStatus> waitForStatus(Wanted wanted) {
    for (int i = 0; i < 500; ++i) {
      dds::ServerStatus status;
      if (status_.take({&status, 1}) == 1 && wanted(status)) return status;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return std::nullopt;
  }
  /// Waits for a surface field with a displacement of at least `size`, m, for at most 10 s. @return number of
  /// floats
  [[nodiscard]] std::size_t waitForDisplacement(double size);

 private:
  static void onForce(dds::ReaderView<dds::ToolForce> reader, void* context) noexcept;
  void sendLoop();

  std::uint32_t tool_id_;
  mutable std::mutex mutex_;
  std::vector<dds::ToolForce> forces_;
  std::vector<dds::ToolForce> other_forces_;
  Point position_{};
  std::atomic<std::uint64_t> seq_{0};
  std::atomic<bool> sending_{false};
  std::thread sender_;

  dds::Participant participant_;
  dds::Writer<dds::ToolPose> poses_;
  dds::Writer<dds::ToolAnnouncement> announcements_;
  dds::Reader<dds::SurfaceMesh> surface_;
  dds::Reader<dds::SurfaceDisplacement> displacement_;
  dds::Reader<dds::ServerStatus> status_;
  dds::Reader<dds::ToolForce> answers_;
};

}  // namespace palpate::server::testing
