// SPDX-License-Identifier: Apache-2.0
#include "palpate/haptic/haptic_tool.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "core/devices/path/in_range.h"
#include "force_renderer.h"
#include "palpate/client/status_board.h"
#include "palpate/client/tool_client.h"
#include "palpate/client/wanted_server.h"
#include "palpate/idl/receive_threads.h"
#include "palpate/rt/clock.h"
#include "palpate/rt/scheduling.h"
#include "palpate/rt/triple_buffer.h"

namespace palpate::haptic {
namespace {

const Options& checked(const Options& options) {
  using device::inRange;
  inRange<HapticError>("domain", options.domain, 0, dds::kMaxDomain);
  inRange<HapticError>("tool id", options.tool_id, 0, 3);
  if (options.organ_id)
    inRange<HapticError>("organ id", *options.organ_id, std::int64_t{0}, client::kMaxOrganId);
  if (options.force_limit == 0.0)
    throw HapticError("force limit is missing: say the largest force that the device renders, N");
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
        tool_id_(options.tool_id),
        renderer_(options.max_extrapolation),
        participant_(options.domain, dds::identityFor({dds::Role::kDriver}, options.security)),
        wanted_{options.server_id, options.organ_id},
        announcements_(participant_),
        statuses_(participant_, &Impl::onStatus, this),
        tool_(participant_, options.tool_id, &Impl::onForce, this, {options.server_id, 0}) {
    said_.server_id = options.server_id;
    if (!options.organ_id) target_.store(options.server_id, std::memory_order_relaxed);
    said_.tool_id = options.tool_id;
    dds::assignText(said_.device, options.device);
    said_.device_force_limit = options.force_limit;
    if (options.receive_priority > 0)
      (void)rt::raiseThreadsNamed(dds::kReceiveThreads, options.receive_priority);
  }

  [[nodiscard]] bool waitForServer(std::chrono::milliseconds timeout) const noexcept {
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + timeout;
    while (!knowsServer()) {
      if (Clock::now() >= deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    return tool_.waitForServer(std::max(left, std::chrono::milliseconds(1)));
  }

  std::uint64_t send(const Vec3& position, const Quaternion& orientation, std::uint32_t buttons) noexcept {
    if (!knowsServer()) return 0;
    if (wanted_.organ_id) tool_.want(target_.load(std::memory_order_relaxed));
    const std::int64_t now_ns = rt::monotonicNow();
    announceIfDue(now_ns);
    const Point p{position[0], position[1], position[2]};
    const std::uint64_t seq = tool_.publish(p, orientation, buttons);
    if (seq != 0) renderer_.sent(seq, p, now_ns);
    return seq;
  }

  [[nodiscard]] Force read(const Point* position) noexcept {
    if (arrivals_.update()) renderer_.answered(arrivals_.front());
    const double server_limit = server_limit_.load(std::memory_order_relaxed);
    const double limit = server_limit > 0.0 ? std::min(limit_, server_limit) : limit_;
    return renderer_.at(position, rt::monotonicNow(), limit);
  }

  [[nodiscard]] std::uint64_t leftOut() const noexcept { return tool_.hold().leftOut().count; }
  [[nodiscard]] std::uint64_t tooLate() const noexcept { return renderer_.tooLate(); }
  [[nodiscard]] double nearest() const noexcept { return renderer_.nearest(); }
  [[nodiscard]] double tipRadius() const noexcept { return tip_radius_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::string securityWarning() const {
    return participant_.identity() ? participant_.identity()->warning() : std::string();
  }
  [[nodiscard]] double serverLimit() const noexcept { return server_limit_.load(std::memory_order_relaxed); }

 private:
  // As long as there are poses: a server may begin at any time, or have had no place for the word.
  void announceIfDue(std::int64_t now_ns) noexcept {
    constexpr std::int64_t kPeriod = 500'000'000;
    if (said_ns_ != 0 && now_ns - said_ns_ < kPeriod) return;
    said_ns_ = now_ns;
    said_.server_id = target_.load(std::memory_order_relaxed);
    (void)announcements_.write(said_);
  }

  static void onForce(const dds::ToolForce& force, std::int64_t received_ns, void* context) noexcept {
    auto& self = *static_cast<Impl*>(context);
    const client::ServerRun run{force.server_id, force.session};
    if (run != self.heldRun()) {
      self.setHeld(run);
      if (const auto status = self.statuses_.find(run))
        self.adopt(*status);  // it came before the first answer
    }
    if (force.pose_seq != self.answered_seq_) {
      self.answered_seq_ = force.pose_seq;
      self.first_answer_ns_ = received_ns;
    }
    self.arrivals_.write({arrayOf(force.force), arrayOf(force.stiffness), arrayOf(force.anchor),
                          arrayOf(force.proxy), force.pose_seq, force.flags, force.state, received_ns,
                          self.first_answer_ns_, force.server_id, force.session});
  }

  // Seen half changed, a status is not adopted; the next one comes within a second.
  [[nodiscard]] client::ServerRun heldRun() const noexcept {
    return {held_id_.load(std::memory_order_relaxed), held_session_.load(std::memory_order_relaxed)};
  }
  void setHeld(const client::ServerRun& run) noexcept {
    held_id_.store(run.server_id, std::memory_order_relaxed);
    held_session_.store(run.session, std::memory_order_relaxed);
  }

  static void onStatus(const dds::ServerStatus& status, void* context) noexcept {
    auto& self = *static_cast<Impl*>(context);
    const client::ServerRun held = self.heldRun();
    const bool wanted = self.wanted_.fits(status);
    if (self.wanted_.organ_id) self.aimAt(status, wanted);
    if (held == client::runOf(status) || (held == client::ServerRun{} && wanted)) self.adopt(status);
  }

  [[nodiscard]] bool knowsServer() const noexcept {
    return !wanted_.organ_id || target_.load(std::memory_order_relaxed) != dds::kServerAny;
  }

  // At the first server of the organ that is heard, and at the next one when that is not heard any more; at none while that
  // server has another organ: without poses no force is an answer. On the receive thread.
  void aimAt(const dds::ServerStatus& status, bool wanted) noexcept {
    if (status.state != dds::server_state::kRunning) return;
    if (!wanted) {
      std::uint32_t other = status.server_id;
      (void)target_.compare_exchange_strong(other, dds::kServerAny, std::memory_order_relaxed);
      return;
    }
    const std::int64_t now_ns = rt::monotonicNow();
    const std::uint32_t target = target_.load(std::memory_order_relaxed);
    const bool silent = now_ns - target_heard_ns_ > client::StatusBoard::kSilenceNs;
    if (target != status.server_id && target != dds::kServerAny && !silent) return;
    target_heard_ns_ = now_ns;
    target_.store(status.server_id, std::memory_order_relaxed);
  }

  // Two independent numbers: relaxed order suffices.
  void adopt(const dds::ServerStatus& status) noexcept {
    if (status.state != dds::server_state::kRunning) return;
    if (status.force_limit > 0.0) server_limit_.store(status.force_limit, std::memory_order_relaxed);
    const double radius = status.tip_radius[tool_id_];
    if (radius >= 0.0 && radius <= 0.05) tip_radius_.store(radius, std::memory_order_relaxed);
  }

  double limit_;
  std::uint32_t tool_id_;
  ForceRenderer renderer_;
  rt::TripleBuffer<Answer> arrivals_;  // from the receive thread to the caller's
  std::atomic<double> server_limit_{0.0};
  std::atomic<double> tip_radius_{0.0};
  dds::Participant participant_;
  client::WantedServer wanted_;
  std::atomic<std::uint32_t> target_{
      dds::kServerAny};              // of the organ that is wanted, or the one that is named
  std::int64_t target_heard_ns_{0};  // the receive thread's
  dds::Writer<dds::ToolAnnouncement> announcements_;
  dds::ToolAnnouncement said_{};                         // the sender's
  std::int64_t said_ns_{0};                              // 0: never
  std::atomic<std::uint32_t> held_id_{dds::kServerAny};  // the receive threads' only
  std::atomic<std::uint64_t> held_session_{0};
  std::uint64_t answered_seq_{0};    // the receive thread's: of the newest answer,
  std::int64_t first_answer_ns_{0};  // and when the first one to that pose arrived
  client::StatusBoard statuses_;
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

std::uint64_t HapticTool::leftOut() const noexcept {
  return impl_->leftOut();
}

std::uint64_t HapticTool::tooLate() const noexcept {
  return impl_->tooLate();
}

double HapticTool::nearest() const noexcept {
  return impl_->nearest();
}

double HapticTool::tipRadius() const noexcept {
  return impl_->tipRadius();
}

std::string HapticTool::securityWarning() const {
  return impl_->securityWarning();
}

double HapticTool::serverForceLimit() const noexcept {
  return impl_->serverLimit();
}

}  // namespace palpate::haptic
