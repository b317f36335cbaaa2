// SPDX-License-Identifier: Apache-2.0
#include "arrivals.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "palpate/rt/clock.h"

namespace palpate::viewer {
namespace {

// Pages get numbers, their sums and their lengths as float32. An answer that float32 cannot hold is dropped.
bool allFit(std::span<const double> numbers) noexcept {
  constexpr double kLargest = 1e30;
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::fabs(x) <= kLargest; });
}

}  // namespace

Arrivals::Arrivals(const dds::Participant& participant, double rate_hz, WakeFunction wake, void* context)
    : wake_(wake),
      context_(context),
      rate_hz_(rate_hz),
      pace_(rate_hz),
      field_reader_(participant, &Arrivals::onField, this, &Arrivals::admits),
      force_reader_(participant, &Arrivals::onForce, this, &Arrivals::admitsForce) {}

// Judged before the pace, so that other servers' fields do not use it up.
bool Arrivals::admits(const dds::SurfaceDisplacement& field, void* context) noexcept {
  auto& self = *static_cast<Arrivals*>(context);
  if (field.session == 0 || field.session != self.session_.load(std::memory_order_relaxed)) return false;
  const std::int64_t now_ns = rt::monotonicNow();
  self.pace_.setRate(self.rate_hz_.load(std::memory_order_relaxed));
  if (!self.pace_.admits(now_ns)) return false;
  return true;
}

bool Arrivals::admitsForce(const dds::ToolForce& force, void* context) noexcept {
  const auto& self = *static_cast<const Arrivals*>(context);
  const double sizes[] = {force.penetration, force.domain_radius};
  return force.session != 0 && force.session == self.session_.load(std::memory_order_relaxed) &&
         force.tool_id < 4 &&  // palpate.idl
         allFit(force.force) && allFit(force.stiffness) && allFit(force.anchor) && allFit(force.proxy) &&
         allFit(sizes);
}

void Arrivals::keep(const dds::SurfaceDisplacement& field, std::int64_t now_ns) {
  const auto& u = field.displacement;
  if (u._length > kMostNumbers) return;
  const std::lock_guard lock(mutex_);
  field_.session = field.session;
  field_.organ_id = field.organ_id;
  field_.model_id = field.model_id;
  field_.topology_revision = field.topology_revision;
  field_.seq = field.seq;
  field_.received_ns = now_ns;
  field_.displacement.assign(u._buffer, u._buffer + u._length);
  fresh_ = true;
}

void Arrivals::onField(dds::ReaderView<dds::SurfaceDisplacement> reader, void* context) noexcept {
  auto& self = *static_cast<Arrivals*>(context);
  const std::int64_t now_ns = rt::monotonicNow();
  const auto samples = reader.takeLoaned();
  for (std::size_t i = 0; i < samples.size(); ++i) self.keep(samples[i], now_ns);
  if (!samples.empty()) self.wake_(self.context_);
}

void Arrivals::onForce(dds::ReaderView<dds::ToolForce> reader, void* context) noexcept {
  auto& self = *static_cast<Arrivals*>(context);
  const std::int64_t now_ns = rt::monotonicNow();
  std::array<dds::ToolForce, dds::kMaxTake> forces;
  const std::size_t count = reader.take(forces);
  const std::lock_guard lock(self.mutex_);
  for (std::size_t i = 0; i < count && self.forces_.size() < kMostForces; ++i)
    self.forces_.push_back({forces[i], now_ns});
}

bool Arrivals::takeField(ArrivedField& field) {
  const std::lock_guard lock(mutex_);
  if (!fresh_) return false;
  std::swap(field, field_);
  fresh_ = false;
  return true;
}

void Arrivals::takeForces(std::vector<TimedForce>& forces) {
  forces.clear();
  const std::lock_guard lock(mutex_);
  std::swap(forces, forces_);
}

}  // namespace palpate::viewer
