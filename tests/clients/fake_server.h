// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"
#include "small_surface.h"

namespace palpate::testing {

/// How a FakeServer behaves.
struct FakeServerOptions {
  double stiffness{500.0};  ///< N/m: force = stiffness * depth below z = 0.05 m + tip radius, along +z
  double damping_s{0.0};  ///< b / stiffness of a damper on the force, as CouplingDamper by the wall clock, s
  double tip_radius{0.005};  ///< m
  bool far{false};           ///< the organ lies where no tool comes: no contact
  std::uint32_t server_id{0};
  std::uint64_t session{1};
  std::uint64_t first_seq{1};      ///< of its forces
  std::uint64_t drop_every{0};     ///< leaves out every n-th ToolForce, to be found as lost; 0: none
  std::uint64_t overrun_every{0};  ///< counts an overrun with every n-th ToolForce; 0: none
  std::uint64_t stall_every{0};    ///< stands still for 40 ms after every n-th ToolForce; 0: never
  std::uint64_t leave_after{0};    ///< flags kShuttingDown from this ToolForce on; 0: never
  double wrong_force{0.0};         ///< added to each force, N
  double wrong_penetration{0.0};   ///< added to each penetration, m
  bool wild_stamps{false};         ///< of the forces: the least and the largest number in turn
};

/// Speaks the server's side of the wire, with a spring for an organ: the client programs can be judged
/// against numbers known in closed form. One tool.
class FakeServer {
 public:
  FakeServer(std::uint32_t domain, const FakeServerOptions& options);
  ~FakeServer();
  FakeServer(const FakeServer&) = delete;
  FakeServer& operator=(const FakeServer&) = delete;

 private:
  void onPose(dds::ReaderView<dds::ToolPose> reader) noexcept;
  void announce();
  void run();
  void answer(const dds::ToolPose& pose, std::uint64_t seq);
  [[nodiscard]] double damped(double spring, std::int64_t now_ns) noexcept;
  void sendField(double depth, std::uint64_t seq);

  FakeServerOptions options_;
  SmallSurface surface_;
  dds::Participant participant_;
  dds::Writer<dds::SurfaceMesh> meshes_;
  dds::Writer<dds::ServerStatus> statuses_;
  dds::ServerStatus status_{};
  dds::Writer<dds::ToolForce> forces_;
  dds::Writer<dds::SurfaceDisplacement> fields_;
  std::mutex mutex_;
  double spring_{0.0}, rate_{0.0};  // of the damper: force of the last tick, N, and its change, N/s
  std::int64_t ticked_ns_{0};       // of the last tick
  dds::ToolPose pose_{};
  bool seen_{false};
  std::uint64_t superseded_{0};
  bool used_{true};
  dds::Reader<dds::ToolPose> poses_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace palpate::testing
