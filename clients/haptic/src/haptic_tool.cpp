// SPDX-License-Identifier: Apache-2.0
#include "palpate/haptic/haptic_tool.h"

#include <atomic>
#include <cmath>

#include "force_renderer.h"
#include "palpate/client/in_range.h"
#include "palpate/client/tool_client.h"
#include "palpate/idl/receive_threads.h"
#include "palpate/rt/clock.h"
#include "palpate/rt/scheduling.h"
#include "palpate/rt/triple_buffer.h"

namespace palpate::haptic {
namespace {

const Options& checked(const Options& options) {
  using client::inRange;
  inRange<HapticError>("domain", options.domain, 0, dds::kMaxDomain);
  inRange<HapticError>("tool id", options.tool_id, 0, 3);
  inRange<HapticError>("force limit (N)", options.force_limit, 0.01, 50.0);
  inRange<HapticError>("max extrapolation (m)", options.max_extrapolation, 0.0, 0.05);
  inRange<HapticError>("receive priority", options.receive_priority, 0, 99);
  return options;
}

template <std::size_t N>
std::array<double, N> arrayOf(const double (&values)[N]) noexcept {
  std::array<double, N> result;
  std::copy(values, values + N, result.begin());
  return result;
}

}  // namespace

class HapticTool::Impl {
 public:
  explicit Impl(const Options& options)
      : limit_(checked(options).force_limit),
        renderer_(options.max_extrapolation),
        participant_(options.domain),
        statuses_(participant_, &Impl::onStatus, this),
        tool_(participant_, options.tool_id, &Impl::onForce, this) {
    if (options.receive_priority > 0)
      (void)rt::raiseThreadsNamed(dds::kReceiveThreads, options.receive_priority);
  }

  [[nodiscard]] bool waitForServer(std::chrono::milliseconds timeout) const noexcept {
    return tool_.waitForServer(timeout);
  }

  std::uint64_t send(const Vec3& position, const Quaternion& orientation, std::uint32_t buttons) noexcept {
    const Point p{position[0], position[1], position[2]};
    const std::uint64_t seq = tool_.publish(p, orientation, buttons);
    if (seq != 0) renderer_.sent(seq, p);
    return seq;
  }

  [[nodiscard]] Force read(const Point* position) noexcept {
    if (arrivals_.update()) renderer_.answered(arrivals_.front());
    const double server_limit = server_limit_.load(std::memory_order_relaxed);
    const double limit = server_limit > 0.0 ? std::min(limit_, server_limit) : limit_;
    return renderer_.at(position, rt::monotonicNow(), limit);
  }

  [[nodiscard]] double tipRadius() const noexcept { return tip_radius_.load(std::memory_order_relaxed); }
  [[nodiscard]] double serverLimit() const noexcept { return server_limit_.load(std::memory_order_relaxed); }

 private:
  static void onForce(const dds::ToolForce& force, std::int64_t received_ns, void* context) noexcept {
    static_cast<Impl*>(context)->arrivals_.write({arrayOf(force.force), arrayOf(force.stiffness),
                                                  arrayOf(force.anchor), arrayOf(force.proxy), force.pose_seq,
                                                  force.flags, force.state, received_ns});
  }

  // Two independent numbers: relaxed order suffices.
  static void onStatus(dds::ReaderView<dds::ServerStatus> reader, void* context) noexcept {
    auto& self = *static_cast<Impl*>(context);
    dds::ServerStatus status;
    while (reader.take({&status, 1}) == 1) {
      if (status.state != dds::server_state::kRunning) continue;
      if (status.force_limit > 0.0) self.server_limit_.store(status.force_limit, std::memory_order_relaxed);
      if (status.tip_radius >= 0.0 && status.tip_radius <= 0.05)
        self.tip_radius_.store(status.tip_radius, std::memory_order_relaxed);
    }
  }

  double limit_;
  ForceRenderer renderer_;
  rt::TripleBuffer<Answer> arrivals_;  // from the receive thread to the caller's
  std::atomic<double> server_limit_{0.0};
  std::atomic<double> tip_radius_{0.0};
  dds::Participant participant_;
  dds::Reader<dds::ServerStatus> statuses_;
  client::ToolClient tool_;  // last: nothing is received while the other members are destroyed
};

HapticTool::HapticTool(const Options& options) try : impl_(std::make_unique<Impl>(options)) {
} catch (const HapticError&) {
  throw;
} catch (const std::exception& error) {
  throw HapticError(error.what());
}

HapticTool::HapticTool(HapticTool&& other) noexcept = default;
HapticTool& HapticTool::operator=(HapticTool&& other) noexcept = default;
HapticTool::~HapticTool() = default;

bool HapticTool::waitForServer(std::chrono::milliseconds timeout) const noexcept {
  return impl_->waitForServer(timeout);
}

std::uint64_t HapticTool::send(const Vec3& position, const Quaternion& orientation,
                               std::uint32_t buttons) noexcept {
  return impl_->send(position, orientation, buttons);
}

Force HapticTool::force() noexcept {
  return impl_->read(nullptr);
}

Force HapticTool::forceAt(const Vec3& position) noexcept {
  const Point p{position[0], position[1], position[2]};
  return impl_->read(&p);
}

double HapticTool::tipRadius() const noexcept {
  return impl_->tipRadius();
}

double HapticTool::serverForceLimit() const noexcept {
  return impl_->serverLimit();
}

}  // namespace palpate::haptic
