// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/touch_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "palpate/testing/synthetic_model.h"
#include "tools/examine/certify/certify_error.h"
#include "tools/modelfile/write_model.h"

namespace palpate::certify {
namespace {

using palpate::testing::TemporaryFile;

MetaModel roundOrgan() {
  const TemporaryFile file("sampled.h5");
  palpate::testing::writeSyntheticModel(file.path(), {.subdivisions = 2, .modes = 2});
  return MetaModel::load(file.path());
}

double areaOf(const MetaModel& model, std::int32_t triangle) {
  const std::array<Vec3, 3> X = model.surface().corners(triangle);
  return 0.5 * (X[1] - X[0]).cross(X[2] - X[0]).norm();
}

TEST(TouchSampler, PlacesAreUniformOverTheAccessibleArea) {
  constexpr int kTouches = 100'000;
  const MetaModel model = roundOrgan();
  TouchSampler sampler(model, {0.005, {}, false}, 3);
  std::map<std::int32_t, int> hits;
  Vec3 mean = Vec3::Zero(), squares = Vec3::Zero();
  for (int i = 0; i < kTouches; ++i) {
    const Touch touch = sampler.next();
    const Eigen::Map<const Vec3> lambda(touch.s.barycentric.data());
    ASSERT_NEAR(lambda.sum(), 1.0, 1e-12);
    ASSERT_GE(lambda.minCoeff(), 0.0);
    ASSERT_EQ(touch.position, model.surface().position(touch.s));
    mean += lambda / kTouches;
    squares += lambda.cwiseAbs2() / kTouches;
    ++hits[touch.s.triangle];
  }
  double area = 0.0;
  std::size_t accessible = 0;
  for (std::int32_t t = 0; t < model.surface().triangles(); ++t)
    if (model.surface().accessible(t)) {
      area += areaOf(model, t);
      ++accessible;
    }
  ASSERT_LT(accessible, static_cast<std::size_t>(model.surface().triangles()));
  EXPECT_EQ(hits.size(), accessible);
  for (const auto& [triangle, count] : hits) {
    EXPECT_TRUE(model.surface().accessible(triangle));
    const double expected = kTouches * areaOf(model, triangle) / area;
    EXPECT_NEAR(count, expected, 4.5 * std::sqrt(expected)) << triangle;
  }
  for (int c = 0; c < 3; ++c) {  // of weights that are uniform over a triangle
    EXPECT_NEAR(mean[c], 1.0 / 3.0, 0.005);
    EXPECT_NEAR(squares[c], 1.0 / 6.0, 0.005);
  }
}

TEST(TouchSampler, DirectionsAreUniformOnTheSphereAndLengthsInTheirRange) {
  constexpr int kTouches = 100'000;
  constexpr double kTravel = 0.005;
  const MetaModel model = roundOrgan();
  TouchSampler sampler(model, {kTravel, {}, false}, 5);
  Vec3 mean = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  double length = 0.0, square = 0.0, along_normal = 0.0;
  for (int i = 0; i < kTouches; ++i) {
    const Touch touch = sampler.next();
    const double part = touch.d.norm() / kTravel;
    ASSERT_GE(part, 0.2 - 1e-12);
    ASSERT_LE(part, 1.0 + 1e-12);
    const Vec3 e = touch.d.normalized();
    mean += e / kTouches;
    second += e * e.transpose() / kTouches;
    along_normal += e.dot(model.surface().normal(touch.s)) / kTouches;
    length += part / kTouches;
    square += part * part / kTouches;
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.008);
  EXPECT_LT((second - Mat3::Identity() / 3.0).cwiseAbs().maxCoeff(), 0.005);
  EXPECT_NEAR(along_normal, 0.0, 0.008);
  EXPECT_NEAR(length, 0.6, 0.004);
  EXPECT_NEAR(square, (1.0 - 0.008) / (3.0 * 0.8), 0.004);
}

TEST(TouchSampler, InwardTouchesPushAndLengthsMayBeGiven) {
  const MetaModel model = roundOrgan();
  TouchSampler sampler(model, {0.005, 0.004, true}, 5);
  for (int i = 0; i < 200; ++i) {
    const Touch touch = sampler.next();
    EXPECT_LE(touch.d.dot(model.surface().normal(touch.s)), 0.0);
    EXPECT_NEAR(touch.d.norm(), 0.004, 1e-15);
  }
}

TEST(TouchSampler, ASeedAlwaysDrawsTheSameTouches) {
  const MetaModel model = roundOrgan();
  TouchSampler first(model, {0.005, {}, false}, 7), again(model, {0.005, {}, false}, 7),
      other(model, {0.005, {}, false}, 8);
  for (int i = 0; i < 10; ++i) {
    const Touch touch = first.next(), same = again.next();
    EXPECT_EQ(touch.s, same.s);
    EXPECT_EQ(touch.d, same.d);
    EXPECT_NE(touch.d, other.next().d);
  }
}

TEST(TouchSampler, TheSeedIsTheContents) {
  const MetaModel model = roundOrgan();
  EXPECT_EQ(seedOf(model), std::stoull(model.digest().hex().substr(0, 16), nullptr, 16) >> 11U);
  EXPECT_LT(seedOf(model), 1ULL << 53U);
}

TEST(TouchSampler, RefusesAnOrganThatCannotBeTouched) {
  modelfile::ModelData data = palpate::testing::syntheticModel({.subdivisions = 1, .modes = 2});
  std::fill(data.contact_accessible.begin(), data.contact_accessible.end(), std::uint8_t{0});
  const TemporaryFile file("untouchable.h5");
  modelfile::writeModel(file.path(), data);
  const MetaModel model = MetaModel::load(file.path());
  EXPECT_THROW(TouchSampler(model, {0.005, {}, false}, 1), CertifyError);
}

}  // namespace
}  // namespace palpate::certify
