// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/reference_field.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/base/multi_index.h"

namespace palpate::bench {

namespace {

using modelfile::ModelData;

/// Of orders two and more: those that contact positions have.
std::vector<double> functionsOf(const MetaModel& model, const FieldSource& source) {
  std::vector<double> phi(static_cast<std::size_t>(model.functions().size()));
  model.functions().evaluate(source.parameter, phi);
  phi.erase(phi.begin(), phi.begin() + kLinearCoefficients);
  return phi;
}

/// What a node of the patch carries.
struct Load {
  std::size_t green;  ///< its Green's function
  Vec3 f;             ///< N
};
std::vector<Load> loadsOf(const ModelData& data, const MetaModel& model, const FieldSource& source) {
  PatchNodes patch = model.patches().room();
  model.patches().at(source.s, false, patch);
  PatchStiffness::Value stiffness;
  model.stiffness().at(model.surface(), source.s, stiffness);
  std::vector<Load> loads;
  for (std::size_t i = 0; i < patch.count; ++i) {
    const auto green = std::find(data.green_node.begin(), data.green_node.end(), patch.node[i]);
    if (green == data.green_node.end())
      throw std::invalid_argument(
          "/green/node lacks node " + std::to_string(patch.node[i]) +
          ": fields of a model in which nodes share their loads (--target handheld) are "
          "not compared");
    loads.push_back({static_cast<std::size_t>(green - data.green_node.begin()),
                     source.gain * patch.weight[i] * (stiffness.K * source.parameter)});
  }
  return loads;
}

/// u += X^T y
template <typename Number>
void addModes(const ModelData& data, std::span<const Number> y, std::vector<double>& u) {
  for (std::size_t k = 0; k < y.size(); ++k)
    for (std::size_t i = 0; i < u.size(); ++i)
      u[i] += static_cast<double>(y[k]) * static_cast<double>(data.modes_X[k * u.size() + i]);
}

/// Near blocks as the file has them.
struct Near {
  std::span<const std::int64_t> offset;
  std::span<const std::int32_t> node;
  std::span<const float> field;
};

/// u += the near block of one source
void addNear(const Near& near, std::size_t source, std::span<const double> phi, double factor,
             std::vector<double>& u) {
  const auto first = static_cast<std::size_t>(near.offset[source]);
  const std::size_t nodes = static_cast<std::size_t>(near.offset[source + 1]) - first;
  for (std::size_t c = 0; c < phi.size(); ++c)
    for (std::size_t i = 0; i < nodes; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t entry = 3 * phi.size() * first + 3 * (c * nodes + i) + axis;
        u[3 * static_cast<std::size_t>(near.node[first + i]) + axis] +=
            factor * phi[c] * static_cast<double>(near.field[entry]);
      }
}

}  // namespace

std::vector<double> referenceAmplitudes(const ModelData& data, const MetaModel& model,
                                        const FieldSource& source) {
  const std::vector<double> phi = functionsOf(model, source);
  const Stencil mix = fieldStencil(model, source.s);
  const std::size_t modes = data.modes_X.size() / data.surface_positions.size();
  std::vector<double> y(modes, 0.0);
  for (std::size_t b = 0; b < mix.count; ++b)
    for (std::size_t c = 0; c < phi.size(); ++c)
      for (std::size_t k = 0; k < modes; ++k) {
        const std::size_t entry = (static_cast<std::size_t>(mix.position[b]) * phi.size() + c) * modes + k;
        y[k] += source.gain * mix.weight[b] * phi[c] * static_cast<double>(data.modes_Y[entry]);
      }
  for (const Load& load : loadsOf(data, model, source))
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = 0; k < modes; ++k)
        y[k] += load.f[Eigen::Index(axis)] *
                static_cast<double>(data.green_Y[(3 * load.green + axis) * modes + k]);
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
  const Stencil mix = fieldStencil(model, source.s);
  const std::vector<double> phi = functionsOf(model, source);
  for (std::size_t b = 0; b < mix.count; ++b)
    addNear({data.near_offset, data.near_node, data.near_field}, static_cast<std::size_t>(mix.position[b]),
            phi, source.gain * mix.weight[b], u);
  for (const Load& load : loadsOf(data, model, source))
    addNear({data.green_offset, data.green_near_node, data.green_near}, load.green,
            {load.f.data(), kLinearCoefficients}, 1.0, u);
  return u;
}

}  // namespace palpate::bench
