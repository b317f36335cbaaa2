// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/response.h"

#include <algorithm>
#include <array>

namespace palpate {

namespace {

/// d, or d scaled to the radius of the domain.
Vec3 clampToDomain(const Vec3& d, double radius) noexcept {
  const double length = d.stableNorm();  // |d|^2 of a huge displacement overflows
  return length > radius ? Vec3(d.stableNormalized() * radius) : d;
}

/// Derivative of d -> radius d / |d|, for |d| > 0.
Mat3 projectionGradient(const Vec3& d, double radius) noexcept {
  const Vec3 direction = d.stableNormalized();
  return (radius / d.stableNorm()) * (Mat3::Identity() - direction * direction.transpose());
}

using Monomials = std::array<double, MonomialBasis::kMaxCoefficients>;

}  // namespace

std::string_view toString(ResponseStatus status) noexcept {
  switch (status) {
    case ResponseStatus::kOk:
      return "ok";
    case ResponseStatus::kClamped:
      return "clamped";
    case ResponseStatus::kNoAnswer:
      return "not_accessible";
  }
  return "unknown";
}

ResponseStatus respond(const MetaModel& model, const ContactPoint& s, const Vec3& d,
                       Response& out) noexcept PALPATE_NONBLOCKING {
  out = Response{};
  const PositionMix mix = model.surface().mix(s);
  if (mix.count == 0) return ResponseStatus::kNoAnswer;
  out.domain_radius = model.response().domainRadius(mix);
  out.displacement = clampToDomain(d, out.domain_radius);
  out.force = model.response().force(mix, out.displacement);
  out.stiffness = model.response().stiffness(mix, out.displacement);
  if (!(d.norm() > out.domain_radius)) return ResponseStatus::kOk;
  out.stiffness = (out.stiffness * projectionGradient(d, out.domain_radius)).eval();
  return ResponseStatus::kClamped;
}

FieldScratch::FieldScratch(const MetaModel& model)
    : amplitudes(static_cast<std::size_t>(model.farField().modes())),
      near_block(static_cast<std::size_t>(model.nearField().scratchSize())) {}

void evaluateField(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
                   std::span<float> u) noexcept PALPATE_NONBLOCKING {
  std::fill(scratch.amplitudes.begin(), scratch.amplitudes.end(), 0.0F);
  const auto forEach = [&](auto&& add) {
    for (const FieldSource& source : sources) {
      const PositionMix mix = model.surface().mix(source.s);
      if (mix.count == 0) continue;
      const Vec3 d = clampToDomain(source.d, model.response().domainRadius(mix));
      Monomials all;
      const std::span<double> monomials(all.data(), static_cast<std::size_t>(model.basis().size()));
      model.basis().evaluate(d / model.attributes().reference_displacement, monomials);
      add(mix, monomials, source.gain);
    }
  };
  forEach([&](const PositionMix& mix, std::span<const double> monomials, double gain) {
    model.farField().addAmplitudes(mix, monomials, gain, scratch.amplitudes);
  });
  model.farField().expand(scratch.amplitudes, u);
  forEach([&](const PositionMix& mix, std::span<const double> monomials, double gain) {
    model.nearField().add(mix, monomials, gain, scratch.near_block, u);
  });
}

void evaluateField(const MetaModel& model, const ContactPoint& s, const Vec3& d, FieldScratch& scratch,
                   std::span<float> u) noexcept PALPATE_NONBLOCKING {
  const std::array<FieldSource, 1> source{FieldSource{s, d, 1.0}};
  evaluateField(model, source, scratch, u);
}

}  // namespace palpate
