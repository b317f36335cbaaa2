// SPDX-License-Identifier: Apache-2.0
#include "field_log.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "palpate/rt/clock.h"

namespace palpate::watch {
namespace {

NodeDisplacement largestOf(const dds::SurfaceDisplacement& field) noexcept {
  NodeDisplacement largest;
  const float* u = field.displacement._buffer;
  for (std::size_t i = 0; i < field.displacement._length / 3; ++i) {
    const device::Point here{u[3 * i], u[3 * i + 1], u[3 * i + 2]};
    if (const double size = length(here); size > largest.size) largest = {i, here, size};
  }
  return largest;
}

}  // namespace

FieldLog::FieldLog(std::shared_ptr<const client::Surface> surface)
    : surface_(std::move(surface)),
      hold_({dds::kServerAny, surface_->session}, kSilenceNs),
      peak_field_(3 * surface_->positions.size(), 0.0F) {
  (void)hold_.address(rt::monotonicNow());  // its silence counts from here on
}

void FieldLog::change(std::shared_ptr<const client::Surface> surface) {
  const std::lock_guard lock(mutex_);
  surface_ = std::move(surface);
  ++model_changes_;
  largest_ = peak_ = {};
  peak_field_.assign(3 * surface_->positions.size(), 0.0F);
}

bool FieldLog::fits(const dds::SurfaceDisplacement& field) const noexcept {
  const auto& u = field.displacement;
  return surface_->model_id == field.model_id && surface_->topology_revision == field.topology_revision &&
         u._length == peak_field_.size() &&
         std::all_of(u._buffer, u._buffer + u._length, [](float value) { return std::isfinite(value); });
}

void FieldLog::add(const dds::SurfaceDisplacement& field) noexcept {
  const bool fit = fits(field);
  const client::ServerRun from{dds::kServerAny, field.session};
  if (!hold_.takes(from, 0, rt::monotonicNow(), fit) && fit) return;
  if (!fit) {
    ++refused_;
    return;
  }
  fields_.add(field.session, field.seq);
  largest_ = largestOf(field);
  if (largest_.size <= peak_.size) return;
  peak_ = largest_;
  std::copy_n(field.displacement._buffer, peak_field_.size(), peak_field_.begin());
}

void FieldLog::take(dds::ReaderView<dds::SurfaceDisplacement> reader) noexcept {
  const auto samples = reader.takeLoaned();
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (samples[i].organ_id == surface_->organ_id) add(samples[i]);
}

FieldSummary FieldLog::summary() const {
  const std::lock_guard lock(mutex_);
  return {fields_.received(), fields_.lost(), refused_, hold_.leftOut().count,
          largest_,           peak_,          surface_, model_changes_};
}

std::vector<float> FieldLog::peakField() const {
  const std::lock_guard lock(mutex_);
  return peak_field_;
}

}  // namespace palpate::watch
