// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/reference_field.h"

#include "core/base/multi_index.h"

namespace palpate::bench {

namespace {

using modelfile::ModelData;

std::vector<double> functionsOf(const MetaModel& model, const FieldSource& source) {
  std::vector<double> phi(static_cast<std::size_t>(model.functions().size()));
  model.functions().evaluate(source.parameter, phi);
  return phi;
}

/// u += X^T y
template <typename Number>
void addModes(const ModelData& data, std::span<const Number> y, std::vector<double>& u) {
  for (std::size_t k = 0; k < y.size(); ++k)
    for (std::size_t i = 0; i < u.size(); ++i)
      u[i] += static_cast<double>(y[k]) * static_cast<double>(data.modes_X[k * u.size() + i]);
}

/// u += the near block of one contact position
void addNear(const ModelData& data, std::size_t position, std::span<const double> phi, double factor,
             std::vector<double>& u) {
  const auto first = static_cast<std::size_t>(data.near_offset[position]);
  const std::size_t nodes = static_cast<std::size_t>(data.near_offset[position + 1]) - first;
  for (std::size_t c = 0; c < phi.size(); ++c)
    for (std::size_t i = 0; i < nodes; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t entry = 3 * phi.size() * first + 3 * (c * nodes + i) + axis;
        u[3 * static_cast<std::size_t>(data.near_node[first + i]) + axis] +=
            factor * phi[c] * static_cast<double>(data.near_field[entry]);
      }
}

}  // namespace

std::vector<double> referenceAmplitudes(const ModelData& data, const MetaModel& model,
                                        const FieldSource& source) {
  const std::vector<double> phi = functionsOf(model, source);
  const PositionMix mix = model.surface().mix(source.s);
  const std::size_t modes = data.modes_Y.size() / (data.contact_node.size() * phi.size());
  std::vector<double> y(modes, 0.0);
  for (std::size_t b = 0; b < static_cast<std::size_t>(mix.count); ++b)
    for (std::size_t c = 0; c < phi.size(); ++c)
      for (std::size_t k = 0; k < modes; ++k) {
        const std::size_t entry = (static_cast<std::size_t>(mix.position[b]) * phi.size() + c) * modes + k;
        y[k] += source.gain * mix.weight[b] * phi[c] * static_cast<double>(data.modes_Y[entry]);
      }
  return y;
}

std::vector<double> referenceModes(const ModelData& data, std::span<const float> y) {
  std::vector<double> u(data.surface_positions.size(), 0.0);
  addModes(data, y, u);
  return u;
}

std::vector<double> referenceField(const ModelData& data, const MetaModel& model, const FieldSource& source) {
  std::vector<double> u(data.surface_positions.size(), 0.0);
  const std::vector<double> y = referenceAmplitudes(data, model, source);
  addModes<double>(data, y, u);
  const PositionMix mix = model.surface().mix(source.s);
  const std::vector<double> phi = functionsOf(model, source);
  for (std::size_t b = 0; b < static_cast<std::size_t>(mix.count); ++b)
    addNear(data, static_cast<std::size_t>(mix.position[b]), phi, source.gain * mix.weight[b], u);
  return u;
}

}  // namespace palpate::bench
