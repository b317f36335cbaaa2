// SPDX-License-Identifier: Apache-2.0
#include "core/response/tool_coupling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../driver.h"
#include "../patch_nodes.h"

namespace palpate::testing {

namespace {

const SyntheticOptions kSmall{.subdivisions = 2};

/// P_s u term by term from the whole field, in double precision.
Vec3 plainAverage(const MetaModel& model, const ContactPoint& s, const std::vector<float>& u) {
  const PatchNodes patch = patchAt(model, s);
  Vec3 sum = Vec3::Zero();
  for (std::size_t j = 0; j < patch.count; ++j)
    sum += patch.weight[j] * Eigen::Map<const Eigen::Vector3f>(u.data() + 3 * patch.node[j]).cast<double>();
  return sum;
}

std::vector<float> fieldOf(const MetaModel& model, const FieldSource& source) {
  FieldScratch scratch(model);
  std::vector<float> u(model.view().surface_positions.size());
  evaluateField(model, std::span(&source, 1), scratch, u);
  return u;
}

ContactPoint anyPoint(const MetaModel& model, std::mt19937& random) {
  for (;;) {
    const auto triangle = static_cast<int>(random() % static_cast<unsigned>(model.surface().triangles()));
    const double a = 1e-3 * (random() % 500U), b = 1e-3 * (random() % 500U);
    if (model.surface().accessible(triangle)) return {triangle, {1.0 - a - b, a, b}};
  }
}

Vec3 anyVector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  return {uniform(random), uniform(random), uniform(random)};
}

/// A point of the model above, one degree at a time from its pole, so that distances are known.
ContactPoint fromPole(const MetaModel& model, double degrees) {
  const double angle = degrees * M_PI / 180.0;
  return model.surface().closestPoint(0.05 * Vec3(std::sin(angle), 0.0, std::cos(angle))).s;
}

}  // namespace

constexpr double kDisplaced = 1e-5;  // m

/// Two touches, and what the one does to the patch of the other.
class Pair {
 public:
  explicit Pair(const MetaModel& model) : model_(model), touches_(model) {}
  PatchMotion motion(const ContactPoint& s, const Vec3& d, const ContactPoint& at) {
    touchWith(model_, s, d, kDisplaced, touches_.all[0]);
    touches_.all[1].patch.moveTo(model_, at);
    return patchMotion(model_, touches_.all[0], touches_.all[1]);
  }
  Vec3 moved(const ContactPoint& s, const Vec3& d, const ContactPoint& at) {
    return motion(s, d, at).at(Vec3::Zero());
  }

 private:
  const MetaModel& model_;
  Touches touches_;
};

TEST(PatchMotion, IsTheFieldAveragedOverThePatch) {
  for (const Parameters parameters : {Parameters::kDisplacement, Parameters::kForce, Parameters::kLevel}) {
    SyntheticOptions options = kSmall;
    options.parameters = parameters;
    const MetaModel model = loadSynthetic(options);
    Pair pair(model);
    std::mt19937 random(3);
    double near = 0.0;
    for (int trial = 0; trial < 200; ++trial) {
      const ContactPoint s = anyPoint(model, random), at = anyPoint(model, random);
      const Vec3 d = anyVector(random, 0.006);
      const Vec3 expected = plainAverage(model, at, fieldOf(model, ownPart(model, s, d)));
      const Vec3 found = pair.moved(s, d, at);
      EXPECT_LT((found - expected).norm(), 2e-6 * expected.norm() + 1e-9) << found << "\n\n" << expected;
      const double gap = (model.surface().position(at) - model.surface().position(s)).norm();
      near = std::max(near, gap < 0.03 ? expected.norm() : 0.0);
    }
    EXPECT_GT(near, 1e-4) << "no pair was near";
  }
}

TEST(PatchMotion, ItsSlopeIsItsDerivativeByWhatTheToolImposes) {
  for (const Parameters parameters : {Parameters::kDisplacement, Parameters::kForce}) {
    SyntheticOptions options = kSmall;
    options.parameters = parameters;
    const MetaModel model = loadSynthetic(options);
    Pair pair(model);
    std::mt19937 random(5);
    double largest = 0.0;
    for (int trial = 0; trial < 60; ++trial) {
      const ContactPoint s = anyPoint(model, random), at = anyPoint(model, random);
      const Vec3 d = anyVector(random, 0.004), y = anyVector(random, 2e-4);
      const auto moved = [&](const Vec3& by) { return pair.moved(s, by, at); };
      const PatchMotion motion = pair.motion(s, d, at);
      const Vec3 change = 0.5 * (moved(d + y) - moved(d - y));
      EXPECT_LT((motion.slope() * y - change).norm(), 0.02 * motion.slope().norm() * y.norm() + 1e-9)
          << trial;
      EXPECT_EQ(motion.at(y), Vec3(motion.at(Vec3::Zero()) + motion.slope() * y));
      largest = std::max(largest, change.norm() / y.norm());
    }
    EXPECT_GT(largest, 0.05);
  }
}

TEST(PatchMotion, ItsSlopeAlongTheSurfaceIsItsDerivativeAsThePatchMoves) {
  constexpr double kOfWeights = 2e-3;
  constexpr double kRounding = 4e-11;  // m; modes of some 0.1 mm in single precision, which may cancel
  for (const Parameters parameters : {Parameters::kDisplacement, Parameters::kForce}) {
    SyntheticOptions options = kSmall;
    options.parameters = parameters;
    const MetaModel model = loadSynthetic(options);
    Pair pair(model);
    std::mt19937 random(8);
    double largest = 0.0;
    for (int trial = 0; trial < 60; ++trial) {
      const ContactPoint s = anyPoint(model, random);
      const Vec3 d = anyVector(random, 0.004), y = anyVector(random, 0.002);
      ContactPoint at = anyPoint(model, random);
      if (!model.surface().complete(at.triangle)) continue;
      for (double& l : at.barycentric) l = 0.1 + 0.7 * l;  // far from the edges
      const auto moved = [&](const ContactPoint& to) { return pair.motion(s, d, to).at(y); };
      const Mat3 by_lambda = pair.motion(s, d, at).along(y);
      const Mat3 slope = by_lambda * model.surface().slopes(at.triangle);
      const double size_of_slope = slope.norm();
      for (std::size_t k = 0; k < 2; ++k) {
        ContactPoint ahead = at, behind = at;
        ahead.barycentric[k] += kOfWeights, ahead.barycentric[2] -= kOfWeights;
        behind.barycentric[k] -= kOfWeights, behind.barycentric[2] += kOfWeights;
        const Vec3 way = model.surface().position(ahead) - model.surface().position(behind);
        EXPECT_LT((moved(ahead) - moved(behind) - slope * way).norm(),
                  2e-3 * size_of_slope * way.norm() + kRounding)
            << trial;
      }
      largest = std::max(largest, size_of_slope);
    }
    EXPECT_GT(largest, 1e-3);
  }
}

TEST(PatchMotion, IsZeroWhereThereIsNoAnswer) {
  const MetaModel model = loadSynthetic(kSmall);
  Pair pair(model);
  const ContactPoint top = fromPole(model, 0.0), bottom = fromPole(model, 180.0);
  const auto moved = [&](const ContactPoint& s, const ContactPoint& at) {
    return pair.moved(s, Vec3(0.0, 0.0, -0.003), at);
  };
  EXPECT_EQ(moved(top, bottom), Vec3(Vec3::Zero()));
  EXPECT_EQ(moved(bottom, top), Vec3(Vec3::Zero()));
  EXPECT_GT(moved(top, fromPole(model, 30.0)).norm(), 1e-5);
}

/// A touch is found once, whoever asks, and what was found for one d or place is not taken for another.
TEST(PatchMotion, DoesNotDependOnWhatWasAskedBefore) {
  const MetaModel model = loadSynthetic(kSmall);
  Pair used(model);
  std::mt19937 random(13);
  const std::array<ContactPoint, 3> places{fromPole(model, 0.0), fromPole(model, 25.0),
                                           fromPole(model, 50.0)};
  const std::array<Vec3, 2> ds{Vec3(0.0, 0.001, -0.003), Vec3(0.001, 0.0, 0.002)};
  for (int trial = 0; trial < 200; ++trial) {
    const ContactPoint s = random() % 4U == 0 ? anyPoint(model, random) : places[random() % 3U];
    const ContactPoint at = random() % 4U == 0 ? anyPoint(model, random) : places[random() % 3U];
    const Vec3& d = ds[random() % 2U];
    Pair fresh(model);
    const PatchMotion found = used.motion(s, d, at);
    const PatchMotion expected = fresh.motion(s, d, at);
    for (std::size_t k = 0; k < found.by.size(); ++k) ASSERT_EQ(found.by[k], expected.by[k]) << trial;
  }
}

/// P_s of what all tools add, each as ownField() has it.
Vec3 movedTogether(const MetaModel& model, const ContactPoint& at, std::span<const ContactPoint> s,
                   std::span<const Vec3> d, std::span<const Vec3> own, std::size_t but) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t b = 0; b < s.size(); ++b)
    if (b != but)
      for (const FieldSource& part : ownField(model, s[b], d[b], own[b]))
        sum += plainAverage(model, at, fieldOf(model, part));
  return sum;
}

TEST(OwnDisplacements, MoveEveryPatchAsPrescribed) {
  for (const Parameters parameters : {Parameters::kDisplacement, Parameters::kForce}) {
    SyntheticOptions options = kSmall;
    options.parameters = parameters;
    const MetaModel model = loadSynthetic(options);
    Touches touches(model);
    const std::array<ContactPoint, 3> s{fromPole(model, 0.0), fromPole(model, 40.0), fromPole(model, -35.0)};
    const std::array<Vec3, 3> d{Vec3(0.0, 0.0, -0.001), Vec3(-0.0005, 0.0, -0.001),
                                Vec3(0.0, 0.0005, -0.001)};
    std::array<Vec3, 3> own;
    ownDisplacements(model, s, d, touches, own);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_LT((own[a] + movedTogether(model, s[a], s, d, own, a) - d[a]).norm(), 1e-6) << "tool " << a;
      EXPECT_GT((own[a] - d[a]).norm(), 1e-5) << "tool " << a << " felt nothing";
    }
  }
}

TEST(OwnDisplacements, OfSmallTouchesAreLinear) {
  const MetaModel model = loadSynthetic(kSmall);
  Touches touches(model);
  const std::array<ContactPoint, 2> s{fromPole(model, 0.0), fromPole(model, 40.0)};
  const std::array<Vec3, 2> d{Vec3(0.0, 0.0, -1e-6), Vec3(-5e-7, 0.0, -1e-6)}, twice{2.0 * d[0], 2.0 * d[1]};
  std::array<Vec3, 2> own, own_twice;
  ownDisplacements(model, s, d, touches, own);
  ownDisplacements(model, s, twice, touches, own_twice);
  for (std::size_t a = 0; a < 2; ++a) EXPECT_LT((own_twice[a] - 2.0 * own[a]).norm(), 1e-3 * own[a].norm());
}

TEST(OwnDisplacements, StayBoundedForToolsAtOnePlace) {
  const MetaModel model = loadSynthetic(kSmall);
  Touches touches(model);
  const std::array<ContactPoint, 2> s{fromPole(model, 10.0), fromPole(model, 10.0)};
  const std::array<Vec3, 2> d{Vec3(0.0, 0.0, -0.001), Vec3(0.0, 0.0, -0.0011)};
  std::array<Vec3, 2> own;
  ownDisplacements(model, s, d, touches, own);
  for (const Vec3& x : own) EXPECT_LT(x.norm(), 300.0 * d[1].norm()) << x;
}

TEST(OwnDisplacements, OfOneToolOrAtRestAreThoseGiven) {
  const MetaModel model = loadSynthetic(kSmall);
  Touches touches(model);
  const std::array<ContactPoint, 2> s{fromPole(model, 0.0), fromPole(model, 40.0)};
  const std::array<Vec3, 2> d{Vec3(0.0, 0.0, -0.001), Vec3::Zero()}, rest{Vec3::Zero(), Vec3::Zero()};
  std::array<Vec3, 2> own{Vec3::Ones(), Vec3::Ones()};
  ownDisplacements(model, std::span(s).first(1), std::span(d).first(1), touches, std::span(own).first(1));
  EXPECT_EQ(own[0], d[0]);
  ownDisplacements(model, s, rest, touches, own);
  EXPECT_EQ(own[1], rest[1]);
  ownDisplacements(model, s, d, touches, own);
  EXPECT_GT(own[1].norm(), 1e-5) << "a tool that holds still takes no part";
}

TEST(Influence, AlongTheSurfaceHasNoPartAlongItsNormal) {
  const MetaModel model = loadSynthetic(kSmall);
  Touches touches(model);
  const std::array<ContactPoint, 2> s{fromPole(model, 0.0), fromPole(model, 40.0)};
  const std::array<Vec3, 2> d{Vec3(0.0, 0.0, -0.001), Vec3(-0.0005, 0.0, -0.001)};
  std::array<Vec3, 2> own;
  Influence influence;
  ownDisplacements(model, s, d, touches, own, &influence);
  for (std::size_t a = 0; a < 2; ++a) {
    const auto* const corner = model.view().surface_triangles.data() + 3 * s[a].triangle;
    const Vec3 n = (nodePosition(model, corner[1]) - nodePosition(model, corner[0]))
                       .cross(nodePosition(model, corner[2]) - nodePosition(model, corner[0]))
                       .normalized();
    EXPECT_GT(influence.along[a].norm(), 1e-4);
    EXPECT_LT((influence.along[a] * n).norm(), 1e-9 * influence.along[a].norm())
        << "the patch does not leave the surface";
  }
}

TEST(OwnField, OfAToolAloneIsItsField) {
  const MetaModel model = loadSynthetic(kSmall);
  const ContactPoint s = fromPole(model, 20.0);
  const Vec3 d(0.0, 0.001, -0.003);
  const auto parts = ownField(model, s, d, d);
  FieldScratch scratch(model);
  std::vector<float> u(model.view().surface_positions.size());
  evaluateField(model, parts, scratch, u);
  const std::vector<float> expected = fieldOf(model, {s, d, 1.0});
  for (std::size_t i = 0; i < u.size(); ++i) ASSERT_NEAR(u[i], expected[i], 1e-9F);
}

}  // namespace palpate::testing
