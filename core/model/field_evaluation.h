// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/contact_point.h"
#include "core/base/types.h"
#include "core/model/meta_model.h"

namespace palpate {

/// Scratch of the field evaluation; one per thread, allocated before the loop.
struct FieldScratch {
  explicit FieldScratch(const MetaModel& model);
  std::vector<float> amplitudes;  ///< [n] y, m
  std::vector<float> near_block;  ///< NearField::scratchSize()
};

/// One tool's part in a field.
struct FieldSource {
  ContactPoint s;
  Vec3 parameter = Vec3::Zero();  ///< Response::parameter; clamped to the domain
  double gain{1.0};               ///< any finite number

  [[nodiscard]] bool operator==(const FieldSource& other) const noexcept {
    return s == other.s && parameter == other.parameter && gain == other.gain;
  }
};

/// Displacement of the surface nodes, far plus near field, superposed over the tools (docs/design.md, Parts).
/// @param[out] u  [Ns][3], m, overwritten; zero when no source is accessible. Real-time: yes.
void evaluateField(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
                   std::span<float> u) noexcept PALPATE_NONBLOCKING;

// evaluateField() in two parts: a tick reports the field where its tools are before it evaluates the rest.

/// @param[out] y  [n] amplitudes of the modes, m. Cost O(C n). Real-time: yes.
void findAmplitudes(const MetaModel& model, std::span<const FieldSource> sources,
                    std::span<float> y) noexcept PALPATE_NONBLOCKING;

/// The whole field. @param scratch  its amplitudes found  @param[out] u  [Ns][3] m. Cost O(n Ns). Real-time: yes.
void fieldOf(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
             std::span<float> u) noexcept PALPATE_NONBLOCKING;

/// The field at points of the surface. @param scratch  its amplitudes found  @param points  triangle -1: zero there
/// @param[out] u  [points] m. Cost O(points n + sources points (C + K_m)). Real-time: yes.
void fieldAt(const MetaModel& model, std::span<const FieldSource> sources, const FieldScratch& scratch,
             std::span<const ContactPoint> points, std::span<Vec3> u) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
