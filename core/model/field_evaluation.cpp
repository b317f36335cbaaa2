// SPDX-License-Identifier: Apache-2.0
#include "core/model/field_evaluation.h"

#include <algorithm>
#include <array>

#include "core/base/index.h"
#include "core/base/length.h"
#include "core/model/clamp_to_length.h"

namespace palpate {

namespace {

using Functions = std::array<double, MonomialBasis::kMaxCoefficients>;

/// One source that the model answers.
struct Answered {
  PositionMix mix;
  Vec3 parameter;                 // as far as fields go
  std::span<const double> all;    // its functions
  std::span<const double> modes;  // those that modes and near fields of positions have
};

/// @return false where the model has no answer
bool answer(const MetaModel& model, const FieldSource& source, Functions& values,
            Answered& out) noexcept PALPATE_NONBLOCKING {
  out.mix = model.surface().mix(source.s);
  if (out.mix.count == 0) return false;
  const auto size = static_cast<std::size_t>(model.functions().size());
  out.parameter =
      fieldFunctions(model, source.parameter, model.response().limit(out.mix), std::span(values).first(size));
  out.all = std::span<const double>(values).first(size);
  out.modes = out.all.last(modeCoefficients(model.attributes(), size));
  return true;
}

Vec3 loadOf(const MetaModel& model, const ContactPoint& s, const Vec3& d) noexcept PALPATE_NONBLOCKING {
  PatchStiffness::Value stiffness;
  model.stiffness().at(model.surface(), s, stiffness);
  return stiffness.K * d;
}

/// The field of a load-driven model where tools are: the modes of all sources, and near fields where they reach.
void sumAt(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
           std::span<const ContactPoint> points, std::span<Vec3> u) noexcept PALPATE_NONBLOCKING {
  std::fill(scratch.amplitudes.begin(), scratch.amplitudes.end(), 0.0F);
  for (const FieldSource& source : sources) {
    Functions values;
    Answered at;
    if (!answer(model, source, values, at)) continue;
    const Stencil stencil = fieldStencil(model, source.s);
    for (std::size_t b = 0; b < stencil.count; ++b)
      model.amplitudes().add(stencil.position[b], at.modes, source.gain * stencil.weight[b],
                             scratch.amplitudes);
    forEachNear(model, source.s, stencil, [&](const NearPart& part) noexcept PALPATE_NONBLOCKING {
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].triangle < 0) continue;
        const NodeMix nodes = model.surface().nodesAt(points[i]);
        for (std::size_t k = 0; k < 3; ++k)
          u[i] += source.gain * part.weight * nodes.weight[k] *
                  part.field.at(part.source, at.modes.first(part.rows), nodes.node[k]);
      }
    });
  }
  model.farField().weigh(scratch.amplitudes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].triangle < 0) continue;
    const NodeMix nodes = model.surface().nodesAt(points[i]);
    for (std::size_t k = 0; k < 3; ++k)
      u[i] += nodes.weight[k] * model.farField().at(scratch.amplitudes, nodes.node[k]);
  }
}

}  // namespace

FieldScratch::FieldScratch(const MetaModel& model)
    : amplitudes(static_cast<std::size_t>(model.farField().modes())),
      near_block(std::max(model.nearField().blockSize(), model.edgeField().blockSize())),
      patch(model.patches().room()),
      loads(model.linearField().room(patch.node.size())),
      unit_near(LinearField::unitNear(static_cast<std::size_t>(model.surface().nodes()), loads)) {}

Vec3 fieldFunctions(const MetaModel& model, const Vec3& parameter, double limit,
                    std::span<double> values) noexcept PALPATE_NONBLOCKING {
  const Vec3 edge = clampToLength(parameter, limit);
  model.functions().evaluate(edge, values);
  if (!model.isDisplacementDriven()) return edge;
  const double beyond = std::min(lengthOf(parameter) / limit, kShownRadii) - 1.0;
  if (!(beyond > 0.0)) return edge;
  const MonomialBasis& basis = model.functions().basis();
  for (int degree = 1; degree <= basis.order(); ++degree)
    for (int k = basis.begin(degree); k < basis.begin(degree + 1); ++k)
      values[index(k)] *= 1.0 + degree * beyond;
  return (1.0 + beyond) * edge;
}

void fieldGradients(const MetaModel& model, const Vec3& d, double limit,
                    std::span<Vec3> gradient) noexcept PALPATE_NONBLOCKING {
  model.functions().gradient(clampToLength(d, limit), gradient);
  const double length = lengthOf(d), past = limit > 0.0 ? length / limit - 1.0 : 0.0;
  const double beyond = std::clamp(past, 0.0, kShownRadii - 1.0);
  const Vec3 along = beyond > 0.0 ? Vec3(d / length) : Vec3::Zero();
  const MonomialBasis& basis = model.functions().basis();
  for (int degree = 1; degree <= basis.order(); ++degree) {
    // of phi(d) = (1 + n beyond) phi(edge); past the end, phi(end) |d| / |end|
    const double across = (1.0 + degree * beyond) / (1.0 + beyond);
    const double radial = past > beyond ? across / degree : 1.0;
    for (int k = basis.begin(degree); k < basis.begin(degree + 1); ++k) {
      Vec3& g = gradient[index(k)];
      g = (across * g + (radial - across) * along.dot(g) * along) / model.functions().reference();
    }
  }
}

void evaluateField(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
                   std::span<float> u) noexcept PALPATE_NONBLOCKING {
  Functions values;
  Answered at;
  std::fill(scratch.amplitudes.begin(), scratch.amplitudes.end(), 0.0F);
  for (const FieldSource& source : sources) {
    if (!answer(model, source, values, at)) continue;
    const Stencil stencil = fieldStencil(model, source.s);
    for (std::size_t b = 0; b < stencil.count; ++b)
      model.amplitudes().add(stencil.position[b], at.modes, source.gain * stencil.weight[b],
                             scratch.amplitudes);
    if (!model.isDisplacementDriven()) continue;
    model.patches().at(source.s, false, scratch.patch);
    model.linearField().find(scratch.patch, scratch.loads);
    model.linearField().addAmplitudes(scratch.loads, source.gain * loadOf(model, source.s, at.parameter),
                                      scratch.amplitudes);
  }
  model.farField().weigh(scratch.amplitudes);
  model.farField().expand(scratch.amplitudes, u);
  for (const FieldSource& source : sources) {
    if (!answer(model, source, values, at)) continue;
    const Stencil stencil = fieldStencil(model, source.s);
    forEachNear(model, source.s, stencil, [&](const NearPart& part) noexcept PALPATE_NONBLOCKING {
      part.field.add(part.source, at.modes.first(part.rows), source.gain * part.weight, scratch.near_block,
                     u);
    });
    if (!model.isDisplacementDriven()) continue;
    model.patches().at(source.s, false, scratch.patch);
    model.linearField().find(scratch.patch, scratch.loads);
    model.linearField().addNear(scratch.loads, source.gain * loadOf(model, source.s, at.parameter),
                                scratch.unit_near, u);
  }
}

void fieldAt(const MetaModel& model, std::span<const FieldSource> sources, FieldScratch& scratch,
             std::span<const ContactPoint> points, std::span<Vec3> u) noexcept PALPATE_NONBLOCKING {
  std::fill(u.begin(), u.end(), Vec3::Zero());
  if (!model.isDisplacementDriven()) {
    sumAt(model, sources, scratch, points, u);
    return;
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const FieldSource& source : sources) {
      Functions values;
      Answered at;
      if (points[i].triangle < 0 || !(source.s == points[i]) || !answer(model, source, values, at)) continue;
      u[i] += source.gain * model.dimple().at(model.dimpleParts(), source.s, at.mix, at.all);
    }
}

}  // namespace palpate
