// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/index.h"
#include "core/base/prefetch.h"
#include "core/base/types.h"
#include "core/model/fields.h"
#include "core/model/linear_field.h"
#include "core/model/patch_stiffness.h"
#include "core/model/smooth_mixing.h"
#include "core/surface/contact_patches.h"
#include "core/surface/smooth_places.h"
#include "core/surface/surface_mesh.h"

namespace palpate {

/// When places of a ContactDimple get their numbers. The second is for one thread only: a page, which cannot wait for all.
enum class DimpleTable { kAtLoad, kWhenTouched };

/// The surface where a tool is: u(X(s); s, d) of its own touch, which a tick reports. A table, so that a tick needs no modes;
/// made from the whole field, which it equals at contact positions, and at edge midpoints up to the degree that edges
/// have; quadratic over a triangle. Of a "displacement" model only.
class ContactDimple {
 public:
  /// What the whole field is made of.
  struct Parts {
    const ModelView& view;
    const SurfaceMesh& surface;
    const SmoothPlaces& places;
    const ContactPatches& patches;
    const PatchStiffness& stiffness;
    const SmoothMixing& mixing;
    const SeparatedField& modes;
    const Amplitudes& amplitudes;
    const NearField& near;
    const NearField& edges;
    const LinearField& linear;
    std::size_t rows;       ///< C
    std::size_t edge_rows;  ///< Ce
    double reference;       ///< d_ref, m
  };
  ContactDimple();
  /// Cost O(k n) for each place and patches of k nodes, O(Ce n) for each edge; with kWhenTouched at() has it instead.
  ContactDimple(const Parts& parts, DimpleTable made);
  ~ContactDimple();
  ContactDimple(ContactDimple&&) noexcept;
  ContactDimple& operator=(ContactDimple&&) noexcept;

  /// @param parts  those that it was made of  @param mix  of s  @param phi  [C] the functions that fields are sums of. Cost O(C).
  /// Real-time: yes, of a table made at load.
  [[nodiscard]] Vec3 at(const Parts& parts, const ContactPoint& s, const PositionMix& mix,
                        std::span<const double> phi) const noexcept PALPATE_NONBLOCKING;
  /// Asks the cache for what at() reads. @param place  SmoothPlaces::of() a triangle. Real-time: yes.
  void expect(const std::array<std::int32_t, 6>& place) const noexcept PALPATE_NONBLOCKING {
    if (position_.empty() || place[0] < 0) return;
    for (std::size_t k = 0; k < 3; ++k) {
      prefetch(ofPosition(place[k]), 3 * rows_ * sizeof(float));
      prefetch(ofEdge(place[3 + k]), 3 * edge_rows_ * sizeof(float));
    }
  }

 private:
  class FieldThere;
  void make(const Parts& parts, std::size_t place) const;
  void makeAround(const Parts& parts, const PositionMix& mix, const std::array<std::int32_t, 6>& place) const;
  [[nodiscard]] const float* ofPosition(std::int32_t position) const noexcept PALPATE_NONBLOCKING {
    return position_.data() + 3 * rows_ * index(position);
  }
  [[nodiscard]] const float* ofEdge(std::int32_t place) const noexcept PALPATE_NONBLOCKING {
    return edge_.data() + 3 * edge_rows_ * (index(place) - positions_);
  }

  std::size_t positions_{0}, rows_{0}, edge_rows_{0};  // M, C, 3 + Ce
  mutable std::vector<float> position_;                // [M][C][3] m
  mutable std::vector<float> edge_;                    // [E][3 + Ce][3] m, beyond the mean of the edge's ends
  std::unique_ptr<FieldThere> field_;                  // none once all places have their numbers
};

}  // namespace palpate
