// SPDX-License-Identifier: Apache-2.0
#include "fake_server.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "palpate/rt/pacer.h"

namespace palpate::testing {

FakeServer::FakeServer(std::uint32_t domain, const FakeServerOptions& options)
    : options_(options),
      participant_(domain),
      meshes_(participant_),
      statuses_(participant_),
      forces_(participant_),
      fields_(participant_),
      poses_(
          participant_,
          [](dds::ReaderView<dds::ToolPose> reader, void* context) noexcept {
            static_cast<FakeServer*>(context)->onPose(reader);
          },
          this) {
  announce();
  thread_ = std::thread([this] { run(); });
}

FakeServer::~FakeServer() {
  stop_ = true;
  thread_.join();
}

void FakeServer::announce() {
  dds::SurfaceMesh mesh = surface_.message();
  mesh.session = options_.session;
  (void)meshes_.write(mesh);
  dds::ServerStatus& status = status_;
  status.server_id = options_.server_id;
  status.session = options_.session;
  status.answers_any = true;
  dds::assignText(status.host, "bench");
  dds::assignText(status.model_id, surface_.model_id);
  status.state = dds::server_state::kRunning;
  status.rate_hz = 1000.0;
  std::fill(std::begin(status.tip_radius), std::end(status.tip_radius), options_.tip_radius);
}

void FakeServer::onPose(dds::ReaderView<dds::ToolPose> reader) noexcept {
  dds::ToolPose pose{};
  while (reader.take({&pose, 1}) == 1) {
    const std::lock_guard lock(mutex_);
    if (!used_) ++superseded_;
    pose_ = pose;
    seen_ = true;
    used_ = false;
  }
}

void FakeServer::run() {
  rt::Pacer pacer(1'000'000);
  std::uint64_t seq = options_.first_seq - 1, ticks = 0;
  while (!stop_) {
    pacer.wait();
    if (ticks++ % 100 == 0) (void)statuses_.write(status_);
    dds::ToolPose pose{};
    {
      const std::lock_guard lock(mutex_);
      if (!seen_) continue;
      pose = pose_;
      used_ = true;
    }
    answer(pose, ++seq);
    if (options_.stall_every > 0 && seq % options_.stall_every == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(40));
  }
}

void FakeServer::answer(const dds::ToolPose& pose, std::uint64_t seq) {
  const double depth = options_.far ? 0.0 : std::max(0.0, 0.05 + options_.tip_radius - pose.position[2]);
  dds::ToolForce force{};
  force.server_id = options_.server_id;
  force.session = options_.session;
  force.tool_id = pose.tool_id;
  force.seq = seq;
  force.pose_seq = pose.seq;
  force.pose_stamp_ns = pose.stamp_ns;
  force.stamp_ns = rt::monotonicNow();
  force.force[2] = damped(options_.stiffness * depth, force.stamp_ns);
  force.force[2] += options_.wrong_force;
  force.penetration = depth + options_.wrong_penetration;
  using Stamps = std::numeric_limits<std::int64_t>;
  if (options_.wild_stamps) force.stamp_ns = seq % 2 == 0 ? Stamps::min() : Stamps::max();
  force.wakeup_ns = 50'000;
  force.tick_ns = 70'000;
  if (options_.overrun_every > 0) force.overruns = seq / options_.overrun_every;
  if (depth > 0.0) {
    force.flags = dds::flag::kInContact;
    force.state = dds::tool_state::kStick;
  }
  if (options_.leave_after > 0 && seq >= options_.leave_after) force.flags |= dds::flag::kShuttingDown;
  const std::lock_guard lock(mutex_);
  force.superseded = superseded_;
  if (options_.drop_every == 0 || seq % options_.drop_every != 0) (void)forces_.write(force);
  sendField(depth, seq);
}

// The damper decays by the server's clock, also while the device stands still.
double FakeServer::damped(double spring, std::int64_t now_ns) noexcept {
  constexpr double kSmoothing = 2e-3;  // s
  const double dt = 1e-9 * static_cast<double>(now_ns - ticked_ns_);
  if (spring > 0.0 && spring_ > 0.0 && dt > 0.0)
    rate_ += (dt / (dt + kSmoothing)) * ((spring - spring_) / dt - rate_);
  else
    rate_ = 0.0;
  spring_ = spring;
  ticked_ns_ = now_ns;
  return std::clamp(spring + options_.damping_s * rate_, 0.0, 2.0 * spring);
}

void FakeServer::sendField(double depth, std::uint64_t seq) {
  std::array<float, 15> u{};
  u[14] = static_cast<float>(-depth);
  dds::SurfaceDisplacement field{};
  field.session = options_.session;
  dds::assignText(field.model_id, surface_.model_id);
  field.seq = seq;
  field.displacement = {15, 15, u.data(), false};
  (void)fields_.write(field);
}

}  // namespace palpate::testing
