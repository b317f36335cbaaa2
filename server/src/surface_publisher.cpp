// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/surface_publisher.h"

#include <cstdint>
#include <vector>

#include "palpate/idl/error.h"

namespace palpate::server {
namespace {

// A DDS sequence that borrows: dds_write only reads, and nothing is released.
template <class Sequence, class T>
void lend(Sequence& sequence, const T* data, std::size_t size) noexcept {
  sequence._maximum = static_cast<std::uint32_t>(size);
  sequence._length = static_cast<std::uint32_t>(size);
  sequence._buffer = const_cast<T*>(data);
  sequence._release = false;
}

std::vector<std::uint8_t> accessibleNodes(const ModelView& view) {
  std::vector<std::uint8_t> accessible(view.surfaceNodes(), 0);
  for (std::size_t node = 0; node < accessible.size(); ++node) {
    const std::int32_t position = view.position_of_node[node];
    if (position >= 0) accessible[node] = view.contact_accessible[static_cast<std::size_t>(position)];
  }
  return accessible;
}

}  // namespace

SurfacePublisher::SurfacePublisher(const dds::Participant& participant, Channels& channels,
                                   const Facts& facts, const MetaModel& model)
    : channels_(channels), facts_(facts), rest_(participant), displacement_(participant) {
  publishRestSurface(model);
}

void SurfacePublisher::publishRestSurface(const MetaModel& model) {
  const ModelView& view = model.view();
  const std::vector<std::uint32_t> triangles(view.surface_triangles.begin(), view.surface_triangles.end());
  const std::vector<std::uint8_t> accessible = accessibleNodes(view);
  dds::SurfaceMesh mesh{};
  mesh.organ_id = facts_.organ_id;
  dds::assignText(mesh.model_id, facts_.model_id);
  lend(mesh.positions, view.surface_positions.data(), view.surface_positions.size());
  lend(mesh.triangles, triangles.data(), triangles.size());
  lend(mesh.accessible, accessible.data(), accessible.size());
  lend(mesh.mesh_tags, view.surface_mesh_tag.data(), view.surface_mesh_tag.size());
  if (!rest_.write(mesh)) throw dds::DdsError("cannot publish the rest surface");
}

void SurfacePublisher::run() noexcept {
  while (true) {
    channels_.surface_ready.wait();
    if (channels_.stopping.load(std::memory_order_acquire)) return;  // SYNC STOP
    if (channels_.surface.update()) publish(channels_.surface.front());
  }
}

void SurfacePublisher::publish(const SurfaceSample& frame) noexcept {
  dds::SurfaceDisplacement sample{};
  sample.organ_id = facts_.organ_id;
  dds::assignText(sample.model_id, facts_.model_id);
  sample.seq = frame.seq;
  sample.stamp_ns = frame.stamp_ns;
  lend(sample.displacement, frame.displacement.data(), frame.displacement.size());
  if (!displacement_.write(sample)) channels_.failed_writes.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace palpate::server
