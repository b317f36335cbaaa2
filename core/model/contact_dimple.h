// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/index.h"
#include "core/base/prefetch.h"
#include "core/base/types.h"
#include "core/model/fields.h"
#include "core/model/linear_field.h"
#include "core/model/patch_stiffness.h"
#include "core/surface/contact_patches.h"
#include "core/surface/smooth_places.h"

namespace palpate {

/// The surface where a tool is: u(X(s); s, d) of its own touch, which a tick reports. A table, so that a tick needs no modes;
/// made at load from the same modes and near fields as the whole field, and linear between its places: contact positions and
/// middles of edges for order one, which equals the whole field there; contact positions for the rest. Of a "displacement"
/// model only.
class ContactDimple {
 public:
  /// What the model gives at contact positions, orders of two and more. Cost O(k n) for each place and patches of k nodes.
  struct Parts {
    const ModelView& view;
    const ContactPatches& patches;
    const PatchStiffness& stiffness;
    const SurfaceMesh& surface;
    const SeparatedField& modes;
    const Amplitudes& amplitudes;
    const NearField& near;
    const LinearField& linear;
  };
  ContactDimple() = default;
  ContactDimple(const Parts& parts, const SmoothPlaces& places);

  /// @param mix  of s  @param d  m  @param phi  [Cm] the functions of orders two and more at d. Cost O(C). Real-time: yes.
  [[nodiscard]] Vec3 at(const SmoothPlaces& places, const ContactPoint& s, const PositionMix& mix,
                        const Vec3& d, std::span<const double> phi) const noexcept PALPATE_NONBLOCKING;
  /// Asks the cache for what at() reads. @param place  SmoothPlaces::of() a triangle. Real-time: yes.
  void expect(const std::array<std::int32_t, 6>& place) const noexcept PALPATE_NONBLOCKING {
    if (linear_.empty() || place[0] < 0) return;
    for (const std::int32_t at : place) prefetch(linear_[index(at)]);
    const std::size_t bend = 3 * bend_count_;
    for (std::size_t k = 0; k < 3; ++k)
      prefetch(bends_.data() + bend * index(place[k]), bend * sizeof(float));
  }

 private:
  std::vector<Eigen::Matrix3f> linear_;  // [places] du/dd at rest, 1
  std::vector<float> bends_;             // [M][Cm][3] m
  std::size_t bend_count_{0};            // Cm
};

}  // namespace palpate
