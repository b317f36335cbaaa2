// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/surface_publisher.h"

namespace palpate::server {

void SurfacePublisher::run() noexcept {
  constexpr std::int64_t kLook = 50'000'000;  // ns, how long a reader that comes waits for its first field
  while (true) {
    (void)channels_.surface_ready.waitFor(kLook);
    if (channels_.stopping.load(std::memory_order_acquire)) return;  // SYNC STOP
    const std::uint32_t readers = displacement_.readers();
    channels_.field_readers.store(readers, std::memory_order_relaxed);
    if (readers == 0) surface_.forget();
    if (channels_.surface.update()) publish(channels_.surface.front());
  }
}

void SurfacePublisher::publish(const SurfaceSample& sample) noexcept {
  (void)surface_.show(sample.state);
  channels_.field_overflowed.store(surface_.overflowed(), std::memory_order_relaxed);
  dds::SurfaceDisplacement field{};
  field.organ_id = facts_.organ_id;
  field.session = facts_.session;
  dds::assignText(field.model_id, facts_.model_id);
  field.seq = sample.seq;
  field.stamp_ns = sample.stamp_ns;
  const std::span<const float> u = surface_.displacement();
  dds::lend(field.displacement, u.data(), u.size());
  for (std::size_t tool = 0; tool < sample.poses.size(); ++tool) {
    field.pose_seq[tool] = sample.poses[tool].seq;
    field.pose_stamp_ns[tool] = sample.poses[tool].stamp_ns;
  }
  if (!displacement_.write(field)) channels_.failed_writes.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace palpate::server
