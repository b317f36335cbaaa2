// SPDX-License-Identifier: Apache-2.0
#include "core/model/patch_stiffness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../driver.h"
#include "core/base/index.h"
#include "tools/modelfile/write_model.h"

namespace palpate::testing {

namespace {

constexpr double kHalf = 0.01;  // of the plate's thickness, m

/// A stiffness that turns and grows over the plane z = const, N/m.
Mat3 plateStiffnessAt(const Vec3& X) {
  const double p = 40.0 * X.x() + 25.0 * X.y();
  Mat3 K;
  K << 300.0 + 50.0 * std::sin(p), 20.0 * std::cos(p), 10.0 * std::sin(2.0 * p), 20.0 * std::cos(p), 400.0,
      30.0 * std::cos(0.7 * p), 10.0 * std::sin(2.0 * p), 30.0 * std::cos(0.7 * p),
      450.0 + 80.0 * std::cos(p);
  return K;
}

/// A plate whose upper and lower sides are plane, so that a smooth function over them has one gradient.
const MetaModel& plate() {
  static const MetaModel model = [] {
    SyntheticOptions options;
    options.fixed_below = options.helper_below = -2.0;
    modelfile::ModelData data = syntheticModel(options);
    for (std::size_t i = 2; i < data.surface_positions.size(); i += 3)
      data.surface_positions[i] = kHalf * std::clamp(data.surface_positions[i] / 0.015, -1.0, 1.0);
    std::copy(data.surface_positions.begin(), data.surface_positions.end(), data.mesh_nodes.begin());
    fillStiffness(data, plateStiffnessAt);
    const TemporaryFile file("plane.h5");
    modelfile::writeModel(file.path(), data);
    return MetaModel::load(file.path());
  }();
  return model;
}

Vec3 nodeOf(const MetaModel& model, int triangle, std::size_t k) {
  const auto node = model.view().surface_triangles[3 * index(triangle) + k];
  return Eigen::Map<const Vec3>(model.view().surface_positions.data() + 3 * node);
}

PatchStiffness::Value at(const MetaModel& model, const ContactPoint& s) {
  PatchStiffness::Value value;
  model.stiffness().at(model.surface(), s, value);
  return value;
}

/// Row k of the file's table: K, and d/dx, y, z.
std::array<Mat3, 4> stored(const MetaModel& model, std::size_t place) {
  const double* number = model.view().contact_stiffness.data() + kStiffnessNumbers * place;
  std::array<Mat3, 4> out;
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = i; j < 3; ++j)
      for (Mat3& part : out) part(i, j) = part(j, i) = *number++;
  return out;
}

/// dK along a way over the surface.
Mat3 along(const MetaModel& model, const ContactPoint& s, const Vec3& way) {
  const PatchStiffness::Value value = at(model, s);
  const Vec3 change = model.surface().slopes(s.triangle) * way;
  Mat3 sum = Mat3::Zero();
  for (std::size_t k = 0; k < 3; ++k) sum += change[Eigen::Index(k)] * value.slope[k];
  return sum;
}

}  // namespace

TEST(PatchStiffness, IsWhatTheFileSaysAtItsPlacesAndSoAreItsSlopes) {
  const MetaModel model = loadSynthetic({.subdivisions = 2, .contrast = 0.2});
  std::size_t seen = 0;
  for (std::size_t place = 0; place < model.places().size(); ++place)
    for (const SmoothPlaces::View& view : model.places().views(place)) {
      const std::array<Mat3, 4> expected = stored(model, place);
      EXPECT_LT((at(model, view.s).K - expected[0]).norm(), 1e-12 * expected[0].norm());
      if (!model.surface().complete(view.s.triangle)) continue;
      ++seen;
      for (std::size_t e = 1; e < 3; ++e) {
        const Vec3 way = nodeOf(model, view.s.triangle, e) - nodeOf(model, view.s.triangle, 0);
        Mat3 slope = Mat3::Zero();
        for (std::size_t axis = 0; axis < 3; ++axis) slope += way[Eigen::Index(axis)] * expected[axis + 1];
        EXPECT_LT((along(model, view.s, way) - slope).norm(), 1e-11 * expected[0].norm());
      }
    }
  EXPECT_GT(seen, 1000U);
}

TEST(PatchStiffness, IsSmoothOverTheEdgesOfAPlane) {
  const MetaModel& model = plate();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int crossed = 0;
  const auto flat = [&](int t) {
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(nodeOf(model, t, k).z() - kHalf) > 1e-12) return false;
    return true;
  };
  for (int t = 0; t < model.surface().triangles(); ++t)
    for (int other = 0; other < t && flat(t); ++other) {
      if (!flat(other)) continue;
      ContactPoint here{t, {}}, there{other, {}};
      const double part = uniform(random);
      std::size_t shared = 0;
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t l = 0; l < 3; ++l) {
          if ((nodeOf(model, t, k) - nodeOf(model, other, l)).norm() > 1e-12) continue;
          here.barycentric[k] = there.barycentric[l] = shared++ == 0 ? part : 1.0 - part;
        }
      if (shared != 2) continue;
      ++crossed;
      EXPECT_LT((at(model, here).K - at(model, there).K).norm(), 1e-10);
      for (const Vec3& way : {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0)}) {
        const Mat3 slope = along(model, here, way);
        EXPECT_LT((slope - along(model, there, way)).norm(), 1e-9 * slope.norm() + 1e-8);
      }
    }
  EXPECT_GT(crossed, 200);
}

TEST(PatchStiffness, BetweenItsPlacesFollowsTheFunctionAndItsSlopesAreItsDerivatives) {
  const MetaModel& model = plate();
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  double worst = 0.0;
  for (int t = 0; t < model.surface().triangles(); ++t) {
    const double a = uniform(random), b = uniform(random) * (1.0 - a);
    const ContactPoint s{t, {1.0 - a - b, a, b}};
    const Mat3 exact = plateStiffnessAt(model.surface().position(s));
    worst = std::max(worst, (at(model, s).K - exact).norm() / exact.norm());
    for (std::size_t k = 0; k < 2; ++k) {
      constexpr double kStep = 1e-6;
      ContactPoint ahead = s, behind = s;
      ahead.barycentric[k] += kStep, ahead.barycentric[2] -= kStep;
      behind.barycentric[k] -= kStep, behind.barycentric[2] += kStep;
      const Mat3 slope = (at(model, ahead).K - at(model, behind).K) / (2.0 * kStep);
      const PatchStiffness::Value value = at(model, s);
      EXPECT_LT((value.slope[k] - value.slope[2] - slope).norm(), 1e-6 * exact.norm());
    }
  }
  EXPECT_LT(worst, 5e-4) << "edges of 7 mm, waves of 0.13 m";
  EXPECT_GT(worst, 1e-7) << "this is an interpolant";
}

TEST(PatchStiffness, InTrianglesThatAreNotCompleteIsMixedLinearly) {
  const MetaModel model = loadSynthetic({.subdivisions = 2, .contrast = 0.2});
  int found = 0;
  for (int t = 0; t < model.surface().triangles(); ++t) {
    const ContactPoint s{t, {0.2, 0.3, 0.5}};
    const PositionMix mix = model.surface().mix(s);
    if (mix.count == 0 || model.surface().complete(t)) continue;
    ++found;
    Mat3 expected = Mat3::Zero();
    for (std::size_t b = 0; b < index(mix.count); ++b)
      expected += mix.weight[b] * stored(model, index(mix.position[b]))[0];
    EXPECT_LT((at(model, s).K - expected).norm(), 1e-12 * expected.norm());
    EXPECT_EQ(at(model, s).slope[0], Mat3::Zero());
  }
  EXPECT_GT(found, 10);
}

}  // namespace palpate::testing
