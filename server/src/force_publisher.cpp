// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/force_publisher.h"

#include <algorithm>

#include "palpate/rt/clock.h"

namespace palpate::server {
namespace {

template <std::size_t N>
void copyTo(double (&field)[N], const std::array<double, N>& values) noexcept {
  std::copy(values.begin(), values.end(), field);
}

}  // namespace

dds::ToolForce toWire(const Facts& facts, const ForceRecord& record) noexcept {
  dds::ToolForce force{};
  force.server_id = facts.server_id;
  force.session = facts.session;
  force.model_hash = record.model_hash;
  force.tool_id = record.tool_id;
  force.seq = record.seq;
  force.pose_seq = record.pose_seq;
  force.pose_stamp_ns = record.pose_stamp_ns;
  force.stamp_ns = record.stamp_ns;
  force.flags = record.result.flags;
  force.state = record.result.state;
  copyTo(force.force, record.result.force);
  copyTo(force.stiffness, record.result.stiffness);
  copyTo(force.anchor, record.result.anchor);
  copyTo(force.proxy, record.result.proxy);
  copyTo(force.displacement, record.result.displacement);
  force.domain_radius = record.result.domain_radius;
  force.penetration = record.result.penetration;
  force.wakeup_ns = record.wakeup_ns;
  force.tick_ns = record.previous_tick_ns;
  force.overruns = record.overruns;
  force.superseded = record.superseded;
  force.pose_wait_ns = record.pose_wait_ns;
  return force;
}

void ForcePublisher::sendAll() noexcept {
  ForceRecord record;
  while (channels_.forces.pop(record)) {
    taken_ = writer_.write(toWire(facts_, record));
    if (!taken_) channels_.failed_writes.fetch_add(1, std::memory_order_relaxed);
    (void)channels_.force_delays.push(rt::monotonicNow() - record.handed_ns);
  }
}

void ForcePublisher::run() noexcept {
  bool stopping = false;
  while (!stopping) {
    channels_.force_ready.wait();
    stopping = channels_.stopping.load(std::memory_order_acquire);  // SYNC STOP
    const bool zero =
        channels_.zero_force_made.load(std::memory_order_acquire);  // SYNC ZERO, before the ring is looked at
    sendAll();
    if (zero && taken_ && !zero_told_) {
      channels_.zero_force_sent.post();
      zero_told_ = true;
    }
    channels_.force_rounds.fetch_add(1, std::memory_order_relaxed);
    if (channels_.surface_waits.exchange(false, std::memory_order_relaxed)) channels_.surface_ready.post();
  }
}

}  // namespace palpate::server
