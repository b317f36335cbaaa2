// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/bench/synthetic_fields.h"

#include <array>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "core/base/multi_index.h"
#include "core/data/model_view.h"

namespace palpate::bench {

namespace {

using modelfile::ModelData;

constexpr double kSize = 0.075;        // m; waves are counted over it
constexpr double kAmplitude = 1.3e-3;  // of the first mode, m
constexpr int kWaves = 3;              // of one mode in one direction

struct Wave {
  Eigen::Vector3f number;  ///< 1/m
  float phase;
};

double degreeOf(const MultiIndex& alpha) {
  return alpha[0] + alpha[1] + alpha[2];
}

/// Waves over the organ, as many as the harmonic of that number has.
Wave randomWave(int mode, std::mt19937& random) {
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> phase(0.0, 6.283);
  const Vec3 direction = Vec3(gauss(random), gauss(random), gauss(random)).normalized();
  const double count = 1.0 + std::sqrt(mode / 3.0);
  return {(direction * count / kSize).cast<float>(), static_cast<float>(phase(random))};
}

/// Clamped nodes do not move.
void fillX(const Ellipsoid& surface, int modes, std::mt19937& random, ModelData& data) {
  std::vector<float>& X = data.modes_X;
  const std::size_t row = 3 * surface.nodes.size();
  const float size = std::sqrt(2.0F / 3.0F / kWaves);  // mean square of the vector 1
  X.assign(static_cast<std::size_t>(modes) * row, 0.0F);
  for (int k = 0; k < modes; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (int w = 0; w < kWaves; ++w) {
        const Wave wave = randomWave(k, random);
        float* const x = X.data() + static_cast<std::size_t>(k) * row + axis;
        for (std::size_t i = 0; i < surface.nodes.size(); ++i)
          x[3 * i] += size * std::cos(wave.number.dot(surface.nodes[i].cast<float>()) + wave.phase);
        for (const std::int32_t node : data.mesh_fixed) x[3 * static_cast<std::size_t>(node)] = 0.0F;
      }
}

/// Each amplitude is a wave over the nodes: of unit loads, and of contact positions a tenth for each further degree.
void fillY(const Ellipsoid& surface, int modes, double load, std::mt19937& random, ModelData& data) {
  constexpr int kLinear = static_cast<int>(kLinearCoefficients);
  const MonomialBasis basis(data.attributes.order);
  std::vector<Wave> waves;
  for (int k = 0; k < modes * basis.size(); ++k) waves.push_back(randomWave(k / basis.size(), random));
  const auto amplitude = [&](std::int32_t node, int c, int k) {
    const Eigen::Vector3f X = surface.nodes[static_cast<std::size_t>(node)].cast<float>();
    const Wave& wave = waves[static_cast<std::size_t>(k * basis.size() + c)];
    const double size =
        2.0 * kAmplitude / (1.0 + std::pow(k / 2.5, 1.5)) * std::pow(0.1, degreeOf(basis[c]) - 1.0);
    return static_cast<float>(size) * std::cos(wave.number.dot(X) + wave.phase);
  };
  for (const std::int32_t node : data.contact_node)
    for (int c = kLinear; c < basis.size(); ++c)
      for (int k = 0; k < modes; ++k) data.modes_Y.push_back(amplitude(node, c, k));
  for (const std::int32_t node : data.green_node)
    for (int c = 0; c < kLinear; ++c)
      for (int k = 0; k < modes; ++k)
        data.green_Y.push_back(amplitude(node, c, k) / static_cast<float>(load));
}

/// Falls smoothly from 1 to 0 at the radius.
double window(double r, double radius) {
  const double x = r / radius;
  return x < 1.0 ? (1.0 - x * x) * (1.0 - x * x) : 0.0;
}

/// The part that the modes lack: a dent as wide as the patch, a tenth for each further degree, m.
Vec3 dent(const ModelAttributes& a, const MultiIndex& alpha, double r) {
  const Vec3 along(alpha[0], alpha[1], alpha[2]);
  const double size = 0.3 * a.reference_displacement * std::pow(0.1, degreeOf(alpha) - 1.0);
  return size * std::exp(-0.5 * std::pow(r / a.patch_radius, 2)) * window(r, a.near_radius) *
         along.normalized();
}

/// Coefficients from `first` to before `end` of dents at some nodes, over a load.
struct Dents {
  std::vector<std::int64_t>& offset;
  std::vector<std::int32_t>& node;
  std::vector<float>& field;
};
void fillDents(const Ellipsoid& surface, const ModelAttributes& a, std::span<const std::int32_t> centres,
               std::array<int, 2> range, double load, const Dents& out) {
  const MonomialBasis basis(a.order);
  out.offset.push_back(0);
  for (const std::int32_t node : centres) {
    const Vec3& X = surface.nodes[static_cast<std::size_t>(node)];
    std::vector<double> distance;
    for (std::size_t i = 0; i < surface.nodes.size(); ++i) {
      const double r = (surface.nodes[i] - X).norm();
      if (r >= a.near_radius) continue;
      out.node.push_back(static_cast<std::int32_t>(i));
      distance.push_back(r);
    }
    for (int k = range[0]; k < range[1]; ++k)
      for (const double r : distance) {
        const Vec3 u = dent(a, basis[k], r) / load;
        for (int axis = 0; axis < 3; ++axis) out.field.push_back(static_cast<float>(u[axis]));
      }
    out.offset.push_back(static_cast<std::int64_t>(out.node.size()));
  }
}

}  // namespace

void fillModes(const Ellipsoid& surface, int modes, double load, ModelData& data) {
  std::mt19937 random(1);
  fillX(surface, modes, random, data);
  fillY(surface, modes, load, random, data);
}

void fillNear(const Ellipsoid& surface, double load, ModelData& data) {
  constexpr int kLinear = static_cast<int>(kLinearCoefficients);
  const ModelAttributes& a = data.attributes;
  fillDents(surface, a, data.contact_node, {kLinear, MonomialBasis::size(a.order)}, 1.0,
            {data.near_offset, data.near_node, data.near_field});
  fillDents(surface, a, data.green_node, {0, kLinear}, load,
            {data.green_offset, data.green_near_node, data.green_near});
}

}  // namespace palpate::bench
