// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "palpate/core/response.h"

namespace palpate {

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
