// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/tool_coupling.h"

#include <algorithm>
#include <array>

#include "load_driven.h"

namespace palpate {

namespace {

std::size_t index(std::int64_t i) noexcept {
  return static_cast<std::size_t>(i);
}

/// What a tool that imposes d by itself adds to the field.
FieldSource sourceOf(const MetaModel& model, const ContactPoint& s, const Vec3& d) noexcept {
  if (model.attributes().parameters == Parameters::kDisplacement) return {s, d, 1.0};
  Response response;
  (void)respond(model, s, d, response);  // without an answer its parameter is zero, and so is the field
  return {s, response.parameter, 1.0};
}

}  // namespace

Vec3 patchDisplacement(const MetaModel& model, const FieldSource& source, const ContactPoint& at,
                       FieldScratch& scratch) noexcept PALPATE_NONBLOCKING {
  const PositionMix from = model.surface().mix(source.s), to = model.surface().mix(at);
  if (from.count == 0 || to.count == 0) return Vec3::Zero();
  const PatchAverage& patch = model.patchAverage();
  std::array<double, MonomialBasis::kMaxCoefficients> all;
  const std::span<double> phi(all.data(), index(model.functions().size()));
  model.functions().evaluate(clampToDomain(source.parameter, model.response().limit(from)), phi);

  std::fill(scratch.amplitudes.begin(), scratch.amplitudes.end(), 0.0F);
  model.farField().addAmplitudes(from, phi, source.gain, scratch.amplitudes);
  Vec3 sum = patch.ofModes(to, scratch.amplitudes);
  const std::span<float> memory(scratch.near_block);
  const std::span<float> table = memory.last(index(model.surface().nodes()));
  for (std::size_t b = 0; b < index(from.count); ++b) {
    if (!patch.meets(from.position[b], to)) continue;
    const NearField::Block block =
        model.nearField().block(from.position[b], phi, source.gain * from.weight[b], memory);
    sum += patch.ofBlock(to, block.nodes, block.u, table);
  }
  return sum;
}

double ownDisplacements(const MetaModel& model, std::span<const ContactPoint> s, std::span<const Vec3> d,
                        int sweeps, FieldScratch& scratch, std::span<Vec3> own) noexcept PALPATE_NONBLOCKING {
  double change = 0.0;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    change = 0.0;
    for (std::size_t a = 0; a < s.size(); ++a) {
      Vec3 next = d[a];
      for (std::size_t b = 0; b < s.size(); ++b)
        if (b != a) next -= patchDisplacement(model, sourceOf(model, s[b], own[b]), s[a], scratch);
      change = std::max(change, (next - own[a]).norm());
      own[a] = next;
    }
  }
  return change;
}

}  // namespace palpate
