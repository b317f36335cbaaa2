// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/surface_publisher.h"

#include <algorithm>

#include "palpate/rt/clock.h"
#include "palpate/rt/thread_reading.h"

namespace palpate::server {

void SurfacePublisher::run() noexcept {
  constexpr std::int64_t kLook = 50'000'000;  // ns, how long a reader that comes waits for its first field
  while (true) {
    (void)channels_.surface_ready.waitFor(kLook);
    if (channels_.stopping.load(std::memory_order_acquire)) return;  // SYNC STOP
    // Before the look at the newest surface: no older one comes after it.
    const std::uint64_t in_use = channels_.engine_to_show.load(std::memory_order_acquire);  // SYNC SHOWN
    const std::uint32_t readers = displacement_.readers();
    channels_.field_readers.store(readers, std::memory_order_relaxed);
    if (readers == 0 && engine_ != nullptr) engine_->shown.forget();
    const std::int64_t before = rt::readThisThread().cpu_ns;
    const bool published = channels_.surface.update();
    if (published) publish(channels_.surface.front());
    letGo(in_use);
    if (published) rest(rt::readThisThread().cpu_ns - before);
  }
}

// Where real-time threads take all of a processor, the kernel stops them all for 50 ms in each second, the tick too.
void SurfacePublisher::rest(std::int64_t computed_ns) noexcept {
  constexpr std::int64_t kLongest = 100'000'000;  // ns
  rt::sleepUntil(rt::monotonicNow() + std::min(computed_ns, kLongest));
}

// An engine before the one in use is not looked at any more: its last surface was taken just now, or replaced.
void SurfacePublisher::letGo(std::uint64_t in_use) noexcept {
  if (engine_ != nullptr && engine_->number < in_use) {
    engine_ = nullptr;
    channels_.field_overflowed.store(false, std::memory_order_relaxed);
  }
  channels_.engine_shown.store(in_use, std::memory_order_release);  // SYNC SHOWN
}

void SurfacePublisher::publish(const SurfaceSample& sample) noexcept {
  engine_ = sample.engine;
  ShownSurface& surface = engine_->shown;
  (void)surface.show(sample.state);
  channels_.field_overflowed.store(surface.overflowed(), std::memory_order_relaxed);
  dds::SurfaceDisplacement field{};
  field.organ_id = facts_.organ_id;
  field.session = facts_.session;
  dds::assignText(field.model_id, engine_->id);
  field.seq = sample.seq;
  field.stamp_ns = sample.stamp_ns;
  const std::span<const float> u = surface.displacement();
  dds::lend(field.displacement, u.data(), u.size());
  for (std::size_t tool = 0; tool < sample.poses.size(); ++tool) {
    field.pose_seq[tool] = sample.poses[tool].seq;
    field.pose_stamp_ns[tool] = sample.poses[tool].stamp_ns;
  }
  if (!displacement_.write(field)) channels_.failed_writes.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace palpate::server
