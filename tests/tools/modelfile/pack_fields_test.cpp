// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/pack_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/model/field_evaluation.h"
#include "palpate/testing/synthetic_model.h"
#include "tools/modelfile/write_model.h"

namespace palpate::testing {

namespace {

using modelfile::ModelData;
using modelfile::PackedNumbers;

/// Amplitudes of the modes and near field of one unit load, times f.
void addLoad(const ModelData& data, std::size_t g, const Vec3& f, std::vector<double>& u) {
  const std::size_t n = data.modes_X.size() / u.size(),
                    first = static_cast<std::size_t>(data.green_offset[g]);
  const std::size_t K = static_cast<std::size_t>(data.green_offset[g + 1]) - first;
  for (std::size_t load = 0; load < 3; ++load) {
    const double share = f[static_cast<Eigen::Index>(load)];
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < u.size(); ++i)
        u[i] += share * double(data.green_Y[(3 * g + load) * n + k]) * double(data.modes_X[k * u.size() + i]);
    for (std::size_t i = 0; i < 3 * K; ++i)
      u[3 * static_cast<std::size_t>(data.green_near_node[first + i / 3]) + i % 3] +=
          share * double(data.green_near[9 * first + 3 * K * load + i]);
  }
}

/// Functions of the parameter at one position of the file's numbers, in double precision: what the field would be
/// without rounding.
std::vector<double> unrounded(const ModelData& data, const MetaModel& model, std::size_t m, const Vec3& p) {
  std::vector<double> phi(static_cast<std::size_t>(model.functions().size()));
  model.functions().evaluate(p, phi);
  std::vector<double> u(data.surface_positions.size());
  if (data.attributes.parameters == Parameters::kDisplacement) {
    phi.erase(phi.begin(), phi.begin() + 3);
    const ContactPoint s = model.surface().atNode(data.contact_node[m]);
    PatchNodes patch = model.patches().room();
    model.patches().at(s, false, patch);
    PatchStiffness::Value stiffness;
    model.stiffness().at(model.surface(), s, stiffness);
    for (std::size_t j = 0; j < patch.count; ++j) {
      const auto g = std::find(data.green_node.begin(), data.green_node.end(), patch.node[j]);
      addLoad(data, static_cast<std::size_t>(g - data.green_node.begin()), patch.weight[j] * stiffness.K * p,
              u);
    }
  }
  const std::size_t n = model.view().modes(), C = phi.size();
  const auto first = static_cast<std::size_t>(data.near_offset[m]);
  const std::size_t K = static_cast<std::size_t>(data.near_offset[m + 1]) - first;
  for (std::size_t c = 0; c < C; ++c) {
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < u.size(); ++i)
        u[i] += phi[c] * double(data.modes_Y[(m * C + c) * n + k]) * double(data.modes_X[k * u.size() + i]);
    for (std::size_t i = 0; i < 3 * K; ++i)
      u[3 * static_cast<std::size_t>(data.near_node[first + i / 3]) + i % 3] +=
          phi[c] * double(data.near_field[3 * C * first + 3 * K * c + i]);
  }
  return u;
}

/// Largest error of a node over the largest displacement, at every seventh position with a parameter of its domain.
double roundingOf(const ModelData& data) {
  const TemporaryFile file("rounded.h5");
  modelfile::writeModel(file.path(), data);
  const MetaModel model = MetaModel::load(file.path());
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const bool level = data.attributes.parameters == Parameters::kLevel;
  FieldScratch scratch(model);
  double worst = 0.0;
  for (std::size_t m = 0; m < data.contact_node.size(); m += 7) {
    const double size = data.contact_domain_radius[m];
    const Vec3 way = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Vec3 p = level ? Vec3(size, 0.0, 0.0) : Vec3(size * way);
    const FieldSource source{model.surface().atNode(data.contact_node[m]), p, 1.0};
    std::vector<float> u(data.surface_positions.size());
    evaluateField(model, std::span(&source, 1), scratch, u);
    const std::vector<double> exact = unrounded(data, model, m, p);
    double error = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < u.size(); i += 3) {
      error = std::max(error, std::hypot(double(u[i]) - exact[i], double(u[i + 1]) - exact[i + 1],
                                         double(u[i + 2]) - exact[i + 2]));
      largest = std::max(largest, std::hypot(exact[i], exact[i + 1], exact[i + 2]));
    }
    worst = std::max(worst, error / largest);
  }
  return worst;
}

}  // namespace

TEST(PackedNumbers, AreWithinHalfAStepAndTheLargestIsExact) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> number(-1.0F, 1.0F);
  for (const float size : {1e-30F, 3.0F, 1e38F}) {
    std::vector<float> block(100);
    for (float& x : block) x = size * number(random);
    block[40] = -size;
    PackedNumbers packed;
    packed.add(block);
    ASSERT_EQ(packed.scale.size(), 1U);
    EXPECT_EQ(packed.whole[40], -32767);
    for (std::size_t i = 0; i < block.size(); ++i)
      EXPECT_NEAR(packed.scale[0] * static_cast<float>(packed.whole[i]) / size, block[i] / size,
                  0.501 / 32767.0);
  }
}

TEST(PackedNumbers, ABlockOfNothingHasAScale) {
  PackedNumbers packed;
  packed.add(std::vector<float>(5, 0.0F));
  packed.add({});
  packed.add(std::vector<float>{1e-40F});
  for (const float scale : packed.scale) EXPECT_GT(scale, 0.0F);
  EXPECT_EQ(packed.whole, std::vector<std::int16_t>(6, 0));
}

TEST(PackedNumbers, WhatIsNoNumberShowsInTheScale) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float wrong : {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
    PackedNumbers packed;
    packed.add(std::vector<float>{1.0F, wrong, 2.0F});
    EXPECT_FALSE(std::isfinite(packed.scale[0])) << wrong;
    EXPECT_EQ(packed.whole.size(), 3U);
  }
}

TEST(PackedFields, RoundingCostsLessThanATenThousandthOfTheField) {
  for (const Parameters parameters : {Parameters::kDisplacement, Parameters::kForce, Parameters::kLevel}) {
    const double rounding = roundingOf(syntheticModel({.modes = 60, .parameters = parameters}));
    EXPECT_LT(rounding, 1e-4) << toString(parameters);
    EXPECT_GT(rounding, 1e-7) << "whole numbers are rounded";
  }
}

}  // namespace palpate::testing
