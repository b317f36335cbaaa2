// SPDX-License-Identifier: Apache-2.0
#include "surfaces.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "palpate/client/error.h"

namespace palpate::viewer {
namespace {

void expectAtMost(std::size_t most, const char* field, std::size_t found) {
  if (found > most)
    throw client::ClientError(std::string("surface from the server: ") + field + " has " +
                              std::to_string(found) + " entries, at most " + std::to_string(most) +
                              " are shown");
}

}  // namespace

Surfaces::Surfaces(const dds::Participant& participant)
    : reader_(participant, nullptr, this, &Surfaces::copy) {}

client::Surface Surfaces::bounded(const dds::SurfaceMesh& message) {
  expectAtMost(kMostRegions, "regions", message.regions._length);
  std::size_t positions = message.positions._length, triangles = message.triangles._length;
  for (std::uint32_t r = 0; r < message.regions._length; ++r) {
    positions += message.regions._buffer[r].positions._length;
    triangles += message.regions._buffer[r].triangles._length;
  }
  expectAtMost(kMostNumbers, "positions", positions);
  expectAtMost(kMostNumbers, "triangles", triangles);
  return client::checkedSurface(message);
}

// DDS calls it for each sample before it keeps one; the sample is copied here and need not be kept.
bool Surfaces::copy(const dds::SurfaceMesh& message, void* context) noexcept {
  constexpr std::size_t kMostArrived = 16;  // between two polls, 20 ms
  auto& self = *static_cast<Surfaces*>(context);
  try {
    Arrived arrived;
    arrived.session = message.session;
    try {
      arrived.surface = bounded(message);
    } catch (const client::ClientError& error) {
      arrived.refusal = error.what();
    }
    const std::lock_guard lock(self.mutex_);
    if (self.arrived_.size() < kMostArrived) self.arrived_.push_back(std::move(arrived));
  } catch (const std::exception& error) {  // out of memory
    spdlog::error("a surface is lost: {}", error.what());
  }
  return false;
}

void Surfaces::poll(std::uint64_t followed) {
  std::vector<Arrived> arrived;
  {
    const std::lock_guard lock(mutex_);
    arrived.swap(arrived_);
  }
  for (Arrived& one : arrived) {
    const std::string refusal = one.refusal;
    if (refusal.empty()) keep(std::move(one), followed);
    if (!refusal.empty()) spdlog::warn("{}", refusal);
    refusal_ = refusal;
  }
}

void Surfaces::keep(Arrived arrived, std::uint64_t followed) {
  std::erase_if(kept_, [&](const Arrived& old) {
    return old.session == arrived.session && old.surface.organ_id == arrived.surface.organ_id;
  });
  if (kept_.size() >= kMostKept) {
    const auto oldest =
        std::find_if(kept_.begin(), kept_.end(), [&](const Arrived& old) { return old.session != followed; });
    kept_.erase(oldest == kept_.end() ? kept_.begin() : oldest);
  }
  kept_.push_back(std::move(arrived));
}

const client::Surface* Surfaces::find(std::uint64_t session, std::uint32_t organ_id) const {
  const auto at = std::find_if(kept_.begin(), kept_.end(), [&](const Arrived& one) {
    return one.session == session && one.surface.organ_id == organ_id;
  });
  return at == kept_.end() ? nullptr : &at->surface;
}

}  // namespace palpate::viewer
