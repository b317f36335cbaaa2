// SPDX-License-Identifier: Apache-2.0
#include "next_surface.h"

#include <exception>
#include <utility>

namespace palpate::watch {

NextSurface::NextSurface(const dds::Participant& participant, const client::Surface& now)
    : session_(now.session),
      organ_id_(now.organ_id),
      model_id_(now.model_id),
      reader_(participant, nullptr, this, &NextSurface::onSurface) {}

// DDS calls it for each sample before it keeps one; the sample is copied here and not kept. One that is malformed, or too large for
// the memory, is none: the log goes on with the surface before, and refuses fields that do not fit.
bool NextSurface::onSurface(const dds::SurfaceMesh& message, void* context) noexcept {
  auto& self = *static_cast<NextSurface*>(context);
  if (message.session != self.session_ || message.organ_id != self.organ_id_) return false;
  try {
    auto surface = std::make_shared<const client::Surface>(client::checkedSurface(message));
    const std::lock_guard lock(self.mutex_);
    if (surface->model_id == self.model_id_) return false;
    self.model_id_ = surface->model_id;
    self.next_ = std::move(surface);
  } catch (const std::exception&) {
    return false;
  }
  return false;
}

std::shared_ptr<const client::Surface> NextSurface::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(next_, nullptr);
}

}  // namespace palpate::watch
