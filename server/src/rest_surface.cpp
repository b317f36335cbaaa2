// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/rest_surface.h"

#include <algorithm>
#include <array>
#include <utility>

#include "palpate/idl/error.h"
#include "palpate/rt/clock.h"

namespace palpate::server {
namespace {

constexpr std::int64_t kShortestPause = 1'000'000'000;  // ns
constexpr int kRepeats = 2;                             // a best-effort reader may lose one

bool isVolatile(dds_entity_t writer, dds_instance_handle_t reader) noexcept {
  dds_builtintopic_endpoint_t* found = dds_get_matched_subscription_data(writer, reader);
  if (found == nullptr) return false;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  (void)dds_qget_durability(found->qos, &durability);
  dds_builtintopic_free_endpoint(found);
  return durability == DDS_DURABILITY_VOLATILE;
}

}  // namespace

RestSurface::RestSurface(const dds::Participant& participant, const Facts& facts,
                         std::unique_ptr<const OrganShape> shape)
    : facts_(facts), shape_(std::move(shape)), writer_(participant) {
  if (!write()) throw dds::DdsError("cannot publish the rest surface");
  sent_ns_ = rt::monotonicNow();
}

bool RestSurface::change(std::unique_ptr<const OrganShape> shape) noexcept {
  shape_ = std::move(shape);
  repeats_ = kRepeats;
  sent_ns_ = rt::monotonicNow();
  return write();
}

bool RestSurface::repeatIfAsked(std::int64_t now_ns) noexcept {
  if (now_ns - sent_ns_ < kShortestPause) return true;
  dds_publication_matched_status_t matched{};
  (void)dds_get_publication_matched_status(writer_.handle(), &matched);
  if (matched.total_count != readers_so_far_ && hasVolatileReader()) repeats_ = kRepeats;
  readers_so_far_ = matched.total_count;
  if (repeats_ == 0) return true;
  --repeats_;
  sent_ns_ = now_ns;
  return write();
}

bool RestSurface::hasVolatileReader() const noexcept {
  std::array<dds_instance_handle_t, 64> readers{};
  const dds_return_t count = dds_get_matched_subscriptions(writer_.handle(), readers.data(), readers.size());
  const auto looked_at =
      std::min<std::size_t>(count > 0 ? static_cast<std::size_t>(count) : 0, readers.size());
  return std::any_of(readers.begin(), readers.begin() + static_cast<std::ptrdiff_t>(looked_at),
                     [this](dds_instance_handle_t reader) { return isVolatile(writer_.handle(), reader); });
}

bool RestSurface::write() noexcept {
  dds::SurfaceMesh mesh{};
  mesh.organ_id = facts_.organ_id;
  mesh.session = facts_.session;
  dds::assignText(mesh.model_id, facts_.model_id);
  shape_->lendTo(mesh);
  return writer_.write(mesh);
}

}  // namespace palpate::server
