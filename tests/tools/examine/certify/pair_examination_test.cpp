// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/pair_examination.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../query/box_model.h"
#include "core/response/patch_response.h"
#include "tools/examine/certify/certificate.h"
#include "tools/examine/certify/certify_error.h"
#include "tools/examine/certify/quantile_bound.h"
#include "tools/examine/query/together.h"

namespace palpate::certify {
namespace {

PairFinding pairOf(double distance, double force_error, double field_error) {
  PairFinding pair;
  pair.distance = distance;
  pair.force_error = force_error;
  pair.field_error = field_error;
  pair.solved = true;
  return pair;
}

constexpr double kPatch = 0.01;  // a, m
constexpr double kAsked = 0.01;

void add(std::vector<PairFinding>& pairs, int count, double radii, double force_error, double field_error) {
  for (int i = 0; i < count; ++i) pairs.push_back(pairOf(radii * kPatch, force_error, field_error));
}

TEST(LeastDistance, IsTheNearestOfAGridThatHolds) {
  std::vector<PairFinding> pairs;
  add(pairs, 60, 4.5, 0.005, 0.008);
  EXPECT_EQ(leastDistance(pairs, kPatch, kAsked), kNearestPair * kPatch);
  EXPECT_FALSE(leastDistance(pairs, kPatch, 0.004));
  EXPECT_FALSE(leastDistance(pairs, kPatch, 0.0079));
  add(pairs, 1, 2.5, 0.005, 0.02);
  EXPECT_EQ(leastDistance(pairs, kPatch, kAsked), 3.0 * kPatch);
  pairs.back() = pairOf(1.7 * kPatch, 0.02, 0.001);
  EXPECT_EQ(leastDistance(pairs, kPatch, kAsked), 2.0 * kPatch);
}

TEST(LeastDistance, EndsAtTheFirstThatFailsWhateverFollows) {
  std::vector<PairFinding> pairs;
  add(pairs, 60, 7.5, 0.001, 0.001);
  add(pairs, 10, 5.5, 0.001, 0.05);
  add(pairs, 400, 1.8, 0.001, 0.001);
  std::vector<double> field;
  for (const PairFinding& pair : pairs) field.push_back(pair.field_error);
  ASSERT_LE(statisticsOf(field).bound_95_95.value(), kAsked);  // all pairs together would hold
  EXPECT_EQ(leastDistance(pairs, kPatch, kAsked), 6.0 * kPatch);
}

TEST(LeastDistance, Takes59Pairs) {
  std::vector<PairFinding> pairs;
  add(pairs, 58, 7.5, 0.001, 0.001);
  EXPECT_FALSE(leastDistance(pairs, kPatch, kAsked));
  add(pairs, 1, 2.2, 0.001, 0.001);
  EXPECT_EQ(leastDistance(pairs, kPatch, kAsked), kNearestPair * kPatch);
}

// 5.001 % of pairs are off at any distance, so every distance is a wrong one.
TEST(LeastDistance, IsWrongAtMostAsOftenAsItSays) {
  constexpr int kTrials = 4000, kPairs = 118;
  constexpr double kOff = 0.05001, kRisk = 0.05;
  std::mt19937_64 random(1);
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  int wrong = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<PairFinding> pairs;
    for (int i = 0; i < kPairs; ++i) {
      const double radii = kNearestPair + (kFarthestPair - kNearestPair) * uniform();
      add(pairs, 1, radii, uniform() < kOff ? 0.02 : 0.001, 0.001);
    }
    wrong += leastDistance(pairs, kPatch, kAsked).has_value();
  }
  const double share = wrong / static_cast<double>(kTrials);
  EXPECT_LE(share, kRisk + 4.0 * std::sqrt(kRisk * (1.0 - kRisk) / kTrials));
  EXPECT_GT(share, 0.01);  // and it does name distances
}

TEST(PairsOf, SaysThatPairsAreTooFew) {
  const query::test::BoxModel box;
  std::vector<PairFinding> pairs;
  const auto text = [&] {
    program::Json c = certificateOf(box.model, {{0.001, ""}, {0.001, {}, false}, 1}, {});
    c["two_tools"] = pairsOf(box.model, pairs);
    return toText(c, {{0.001, ""}, {0.001, {}, false}, 1});
  };
  add(pairs, 58, 7.5, 0.5, 0.5);
  EXPECT_NE(text().find("  too few pairs for a bound\n"), std::string::npos) << text();
  EXPECT_EQ(text().find("at no distance"), std::string::npos) << text();
  add(pairs, 1, 7.5, 0.5, 0.5);
  EXPECT_NE(text().find("  at no distance 1 % holds"), std::string::npos) << text();
}

TEST(PairExamination, SolvesBothToolsTogether) {
  constexpr double kTravel = 0.001;
  const query::test::BoxModel box("stable-neo-hookean", 2);
  TouchSampler touches(box.model, {kTravel, {}, false}, 3);
  const double a = box.model.attributes().patch_radius;
  const std::vector<PairFinding> pairs = examinePairs(box.model, box.organ, touches, kTravel, {4, 2});
  ASSERT_EQ(std::count_if(pairs.begin(), pairs.end(), [](const PairFinding& pair) { return pair.solved; }),
            8);
  for (const PairFinding& pair : pairs) {
    EXPECT_GE(pair.distance, kNearestPair * a);
    EXPECT_LE(pair.distance, kFarthestPair * a);
    EXPECT_EQ(pair.distance, (pair.touches[1].position - pair.touches[0].position).norm());
    if (!pair.solved) continue;
    std::vector<query::Touch> asked;
    for (const Touch& touch : pair.touches) asked.push_back({{touch.s, touch.position, 0}, touch.d});
    const query::FullSolution truth = query::solveTogether(box.organ, asked, a, 1);
    const query::JointErrors errors =
        query::coupledErrors(query::askTogether(box.model, asked), asked, truth, box.organ);
    EXPECT_NEAR(pair.field_error, errors.field.max, 1e-6);
    EXPECT_NEAR(pair.min_det_f, truth.min_det_f, 1e-7);
    double expected = 0.0;  // with the floor
    for (std::size_t i = 0; i < 2; ++i) {
      Response at_travel;
      (void)respond(box.model, pair.touches[i].s, kTravel * pair.touches[i].d.normalized(), at_travel);
      const double length = truth.state.forces[i].norm();
      expected =
          std::max(expected, errors.force[i] * length / std::max(length, 0.05 * at_travel.force.norm()));
    }
    EXPECT_NEAR(pair.force_error, expected, 1e-6);
  }
  const program::Json json = pairsOf(box.model, pairs);
  EXPECT_EQ(json["samples"], 8);
  EXPECT_EQ(json["drawn"], pairs.size());
  EXPECT_TRUE(json["force_error"]["bound_95_95"].isNull());
  EXPECT_TRUE(json["least_distance"].isNull());
}

TEST(PairExamination, RefusesAnOrganThatIsTooSmallForPairs) {
  const query::test::BoxModel box;
  TouchSampler touches(box.model, {0.001, {}, false}, 3);
  EXPECT_THROW((void)touches.nextPair(1.0, 2.0), CertifyError);
}

}  // namespace
}  // namespace palpate::certify
