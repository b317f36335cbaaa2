// SPDX-License-Identifier: Apache-2.0
#include "core/model/field_evaluation.h"

#include <algorithm>
#include <array>

#include "core/base/index.h"
#include "core/model/clamp_to_domain.h"

namespace palpate {

FieldScratch::FieldScratch(const MetaModel& model)
    : amplitudes(static_cast<std::size_t>(model.farField().modes())),
      near_block(static_cast<std::size_t>(model.nearField().scratchSize())) {}

namespace {

/// Visits the sources that the model answers: add(mix, phi, gain).
template <typename Add>
void forEachAnswered(const MetaModel& model, std::span<const FieldSource> sources,
                     Add&& add) noexcept PALPATE_NONBLOCKING {
  for (const FieldSource& source : sources) {
    const PositionMix mix = model.surface().mix(source.s);
    if (mix.count == 0) continue;
    const Vec3 p = clampToDomain(source.parameter, model.response().limit(mix));
    std::array<double, MonomialBasis::kMaxCoefficients> all;
    const std::span<double> phi(all.data(), static_cast<std::size_t>(model.functions().size()));
    model.functions().evaluate(p, phi);
    add(mix, std::span<const double>(phi), source.gain);
  }
}

std::array<std::int32_t, 3> cornersOf(const MetaModel& model, const ContactPoint& point) noexcept {
  const std::int32_t* const corner = model.view().surface_triangles.data() + 3 * index(point.triangle);
  return {corner[0], corner[1], corner[2]};
}

}  // namespace

void findAmplitudes(const MetaModel& model, std::span<const FieldSource> sources,
                    std::span<float> y) noexcept PALPATE_NONBLOCKING {
  std::fill(y.begin(), y.end(), 0.0F);
  forEachAnswered(model, sources, [&](const PositionMix& mix, std::span<const double> phi, double gain) {
    model.farField().addAmplitudes(mix, phi, gain, y);
  });
}

void fieldOf(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
             std::span<float> u) noexcept PALPATE_NONBLOCKING {
  model.farField().expand(scratch.amplitudes, u);
  forEachAnswered(model, sources, [&](const PositionMix& mix, std::span<const double> phi, double gain) {
    model.nearField().add(mix, phi, gain, scratch.near_block, u);
  });
}

void fieldAt(const MetaModel& model, std::span<const FieldSource> sources, const FieldScratch& scratch,
             std::span<const ContactPoint> points, std::span<Vec3> u) noexcept PALPATE_NONBLOCKING {
  for (std::size_t i = 0; i < points.size(); ++i) {
    u[i] = Vec3::Zero();
    if (points[i].triangle < 0) continue;
    const std::array<std::int32_t, 3> corners = cornersOf(model, points[i]);
    for (std::size_t k = 0; k < 3; ++k)
      u[i] += points[i].barycentric[k] * model.farField().at(scratch.amplitudes, corners[k]);
  }
  forEachAnswered(model, sources, [&](const PositionMix& mix, std::span<const double> phi, double gain) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i].triangle < 0) continue;
      const std::array<std::int32_t, 3> corners = cornersOf(model, points[i]);
      for (std::size_t b = 0; b < index(mix.count); ++b)
        for (std::size_t k = 0; k < 3; ++k)
          u[i] += gain * mix.weight[b] * points[i].barycentric[k] *
                  model.nearField().at(mix.position[b], phi, corners[k]);
    }
  });
}

void evaluateField(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
                   std::span<float> u) noexcept PALPATE_NONBLOCKING {
  findAmplitudes(model, sources, scratch.amplitudes);
  fieldOf(model, sources, scratch, u);
}

}  // namespace palpate
