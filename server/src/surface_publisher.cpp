// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/surface_publisher.h"

namespace palpate::server {

void SurfacePublisher::run() noexcept {
  constexpr std::int64_t kLook = 50'000'000;  // ns, how long a reader that comes waits for its first field
  while (true) {
    (void)channels_.surface_ready.waitFor(kLook);
    if (channels_.stopping.load(std::memory_order_acquire)) return;  // SYNC STOP
    channels_.field_readers.store(displacement_.readers(), std::memory_order_relaxed);
    if (channels_.surface.update()) publish(channels_.surface.front());
  }
}

void SurfacePublisher::publish(const SurfaceSample& frame) noexcept {
  dds::SurfaceDisplacement sample{};
  sample.organ_id = facts_.organ_id;
  sample.session = facts_.session;
  dds::assignText(sample.model_id, facts_.model_id);
  sample.seq = frame.seq;
  sample.stamp_ns = frame.stamp_ns;
  dds::lend(sample.displacement, frame.displacement.data(), frame.displacement.size());
  if (!displacement_.write(sample)) channels_.failed_writes.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace palpate::server
