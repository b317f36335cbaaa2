// SPDX-License-Identifier: Apache-2.0
#include "core/model/field_evaluation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "../response/random_touch.h"

namespace palpate::testing {

namespace {

/// u += sum_i w_i (Z_i + N_i) K d.
void addLinear(const ContactPoint& s, const Vec3& d, std::vector<double>& u) {
  const ModelView& v = touchedOrgan().view();
  const std::size_t n = v.modes();
  PatchNodes patch = touchedOrgan().patches().room();
  touchedOrgan().patches().at(s, false, patch);
  PatchStiffness::Value stiffness;
  touchedOrgan().stiffness().at(touchedOrgan().surface(), s, stiffness);
  for (std::size_t j = 0; j < patch.count; ++j) {
    const Vec3 f = patch.weight[j] * (stiffness.K * d);
    const auto g = static_cast<std::size_t>(
        std::find(v.green_node.begin(), v.green_node.end(), patch.node[j]) - v.green_node.begin());
    ASSERT_LT(g, v.green_node.size());
    const auto first = static_cast<std::size_t>(v.green_offset[g]);
    const auto K = static_cast<std::size_t>(v.green_offset[g + 1]) - first;
    for (std::size_t load = 0; load < 3; ++load) {
      const double share = f[static_cast<Eigen::Index>(load)];
      for (std::size_t mode = 0; mode < n; ++mode) {
        const double y = share * double(v.green_Y_scale[3 * g + load]) * v.green_Y[(3 * g + load) * n + mode];
        for (std::size_t i = 0; i < u.size(); ++i)
          u[i] += y * double(v.modes_X_scale[mode]) * v.modes_X[i * n + mode];
      }
      for (std::size_t i = 0; i < 3 * K; ++i)
        u[3 * static_cast<std::size_t>(v.green_near_node[first + i / 3]) + i % 3] +=
            share * double(v.green_near_scale[3 * g + load]) *
            v.green_near[9 * (first + i / 3) + 3 * load + i % 3];
    }
  }
}

/// u += sum over the edges round s of 4 lambda_a lambda_b times what their middles add.
void addEdges(const ContactPoint& s, const std::vector<double>& monomial, std::vector<double>& u) {
  const ModelView& v = touchedOrgan().view();
  const std::size_t E = v.edge_offset.size() - 1, C = v.edge_scale.size() / E;
  const std::array<std::int32_t, 6>& place = touchedOrgan().places().of(s.triangle);
  for (std::size_t corner = 0; corner < 3 && place[3] >= 0; ++corner) {
    const double w = 4.0 * s.barycentric[(corner + 1) % 3] * s.barycentric[(corner + 2) % 3];
    const std::size_t e = static_cast<std::size_t>(place[3 + corner]) - v.positions();
    const auto first = static_cast<std::size_t>(v.edge_offset[e]);
    const auto K = static_cast<std::size_t>(v.edge_offset[e + 1]) - first;
    for (std::size_t k = 0; k < C; ++k)
      for (std::size_t i = 0; i < 3 * K; ++i)
        u[3 * static_cast<std::size_t>(v.edge_node[first + i / 3]) + i % 3] +=
            w * monomial[k] * double(v.edge_scale[e * C + k]) * v.edge_field[3 * C * first + k * 3 * K + i];
  }
}

/// The sum of the format's text, term by term, in double precision.
std::vector<double> plainField(const ContactPoint& s, const Vec3& d) {
  const ModelView& v = touchedOrgan().view();
  const std::size_t C = static_cast<std::size_t>(touchedOrgan().functions().size()) - 3, n = v.modes();
  std::vector<double> all(C + 3), u(v.surface_positions.size());
  MonomialBasis(options().order).evaluate(d / options().reference_displacement, all);
  const std::vector<double> monomial(all.begin() + 3, all.end());
  addLinear(s, d, u);
  addEdges(s, monomial, u);
  const Stencil mix = touchedOrgan().mixing().at(touchedOrgan().surface(), s);
  for (std::size_t b = 0; b < mix.count; ++b) {
    const auto m = static_cast<std::size_t>(mix.position[b]);
    const auto first = static_cast<std::size_t>(v.near_offset[m]);
    const auto K = static_cast<std::size_t>(v.near_offset[m + 1]) - first;
    for (std::size_t k = 0; k < C; ++k) {
      const double w = mix.weight[b] * monomial[k];
      for (std::size_t mode = 0; mode < n; ++mode) {
        const double y = w * double(v.modes_Y_scale[m * C + k]) * v.modes_Y[(m * C + k) * n + mode];
        for (std::size_t i = 0; i < u.size(); ++i)
          u[i] += y * double(v.modes_X_scale[mode]) * v.modes_X[i * n + mode];
      }
      for (std::size_t i = 0; i < 3 * K; ++i)
        u[3 * static_cast<std::size_t>(v.near_node[first + i / 3]) + i % 3] +=
            w * double(v.near_scale[m * C + k]) * v.near_field[3 * C * first + k * 3 * K + i];
    }
  }
  return u;
}

}  // namespace

TEST(Field, IsTheSumOfTheFormat) {
  RandomTouch random;
  for (int trial = 0; trial < 10; ++trial) {
    const ContactPoint s = random.contactPoint();
    const Vec3 d = random.vector(0.004);
    const std::vector<float> fast = field(s, d);
    const std::vector<double> plain = plainField(s, d);
    for (std::size_t i = 0; i < fast.size(); ++i) ASSERT_NEAR(fast[i], plain[i], 1e-8);
  }
}

TEST(Field, SourcesAddWithTheirGains) {
  RandomTouch random;
  const FieldSource a{random.contactPoint(), random.vector(0.003), 1.0};
  const FieldSource b{random.contactPoint(), random.vector(0.003), 0.25};
  FieldScratch scratch(touchedOrgan());
  std::vector<float> both(touchedOrgan().view().surface_positions.size());
  const std::array<FieldSource, 2> sources{a, b};
  evaluateField(touchedOrgan(), sources, scratch, both);
  const std::vector<float> one = field(a.s, a.parameter), other = field(b.s, b.parameter);
  for (std::size_t i = 0; i < both.size(); ++i) ASSERT_NEAR(both[i], one[i] + 0.25F * other[i], 1e-8);
}

}  // namespace palpate::testing
