// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/data/region_surfaces.h"
#include "core/model/meta_model.h"
#include "palpate/idl/types.h"

namespace palpate::server {

/// What a model's organ looks like at rest, as SurfaceMesh says it. Immutable. Cost O(tetrahedra). Real-time: no.
class OrganShape {
 public:
  /// `model` must outlive it.
  explicit OrganShape(const MetaModel& model);
  OrganShape(const OrganShape&) = delete;
  OrganShape& operator=(const OrganShape&) = delete;

  /// Lends its arrays to a message; whose organ it is is left to the caller.
  void lendTo(dds::SurfaceMesh& mesh) const;

 private:
  const ModelView& view_;
  double contact_radius_;  // m
  std::string certificate_;
  std::vector<std::uint32_t> triangles_;
  std::vector<std::uint8_t> accessible_;
  std::vector<std::uint8_t> clamped_;
  std::vector<RegionSurface> region_surfaces_;
  std::vector<dds::Region> regions_;  // borrow from these
};

}  // namespace palpate::server
