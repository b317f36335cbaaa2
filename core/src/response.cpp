// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/response.h"

#include <algorithm>
#include <array>

#include "load_driven.h"
#include "palpate/core/length.h"

namespace palpate {

Vec3 clampToDomain(const Vec3& d, double radius) noexcept PALPATE_NONBLOCKING {
  const double length = lengthOf(d);  // |d|^2 of a huge displacement overflows
  return length > radius ? Vec3(d.stableNormalized() * radius) : d;
}

Mat3 projectionGradient(const Vec3& d, double radius) noexcept PALPATE_NONBLOCKING {
  const Vec3 direction = d.stableNormalized();
  return (radius / lengthOf(d)) * (Mat3::Identity() - direction * direction.transpose());
}

namespace {

/// f(s, d) of a "displacement" model.
ResponseStatus answerToDisplacement(const ContactSeries& series, const Vec3& d, Response& out) noexcept {
  out.domain_radius = series.limit();
  out.displacement = clampToDomain(d, out.domain_radius);
  out.parameter = out.displacement;
  out.force = series.value(out.displacement);
  out.stiffness = series.gradient(out.displacement);
  if (!(d.norm() > out.domain_radius)) return ResponseStatus::kOk;
  out.stiffness = (out.stiffness * projectionGradient(d, out.domain_radius)).eval();
  return ResponseStatus::kClamped;
}

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
  const ContactSeries series = model.response().at(mix);
  switch (model.attributes().parameters) {
    case Parameters::kDisplacement:
      return answerToDisplacement(series, d, out);
    case Parameters::kForce:
      return findForce(series, d, out);
    case Parameters::kLevel:
      return findLevel(series, model.attributes(), d, out);
  }
  return ResponseStatus::kNoAnswer;
}

ResponseStatus respondToLoad(const MetaModel& model, const ContactPoint& s, const Vec3& load,
                             Response& out) noexcept PALPATE_NONBLOCKING {
  out = Response{};
  const PositionMix mix = model.surface().mix(s);
  const Parameters parameters = model.attributes().parameters;
  if (mix.count == 0 || parameters == Parameters::kDisplacement) return ResponseStatus::kNoAnswer;
  const ContactSeries series = model.response().at(mix);
  return parameters == Parameters::kForce ? answerToForce(series, load, out)
                                          : answerToLevel(series, model.attributes(), load.x(), out);
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
      const Vec3 p = clampToDomain(source.parameter, model.response().limit(mix));
      std::array<double, MonomialBasis::kMaxCoefficients> all;
      const std::span<double> phi(all.data(), static_cast<std::size_t>(model.functions().size()));
      model.functions().evaluate(p, phi);
      add(mix, phi, source.gain);
    }
  };
  forEach([&](const PositionMix& mix, std::span<const double> phi, double gain) {
    model.farField().addAmplitudes(mix, phi, gain, scratch.amplitudes);
  });
  model.farField().expand(scratch.amplitudes, u);
  forEach([&](const PositionMix& mix, std::span<const double> phi, double gain) {
    model.nearField().add(mix, phi, gain, scratch.near_block, u);
  });
}

void evaluateField(const MetaModel& model, const ContactPoint& s, const Vec3& d, FieldScratch& scratch,
                   std::span<float> u) noexcept PALPATE_NONBLOCKING {
  Response response;
  (void)respond(model, s, d, response);  // without an answer there is no field either
  const std::array<FieldSource, 1> source{FieldSource{s, response.parameter, 1.0}};
  evaluateField(model, source, scratch, u);
}

}  // namespace palpate
