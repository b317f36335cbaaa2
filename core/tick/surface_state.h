// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/max_tools.h"
#include "core/model/field_evaluation.h"

namespace palpate {

/// The sources of a field, at most two of each tool. Real-time: yes.
class FieldSources {
 public:
  [[nodiscard]] std::span<const FieldSource> all() const noexcept PALPATE_NONBLOCKING {
    return std::span(sources_).first(count_);
  }
  void clear() noexcept PALPATE_NONBLOCKING { count_ = 0; }
  void add(const FieldSource& source) noexcept PALPATE_NONBLOCKING { sources_[count_++] = source; }
  /// Bit for bit the same.
  [[nodiscard]] bool operator==(const FieldSources& other) const noexcept PALPATE_NONBLOCKING {
    const auto a = all(), b = other.all();
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  std::array<FieldSource, 2 * kMaxTools> sources_{};
  std::size_t count_{0};
};

/// What the organ's surface is made of after a tick. Numbers only, less than a kilobyte: it crosses threads.
struct SurfaceState {
  FieldSources sources;
  std::uint64_t jumps{
      0};  ///< so far. At the last one the surface began to blend over from what was shown before it
  double blend{0.0};  ///< weight of what was shown then: 1 at the jump, falls to 0 within ramp_time

  [[nodiscard]] bool operator==(const SurfaceState& other) const noexcept PALPATE_NONBLOCKING {
    return sources == other.sources && jumps == other.jumps && blend == other.blend;
  }
};

}  // namespace palpate
