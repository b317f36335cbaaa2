// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/pair_examination.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "../query/box_model.h"
#include "tools/examine/certify/certificate.h"
#include "tools/examine/certify/certify_error.h"
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

TEST(LeastDistance, IsWhereTheBoundOfAllPairsBeyondItHolds) {
  std::vector<PairFinding> pairs;
  for (int i = 0; i < 60; ++i) pairs.push_back(pairOf(0.02 + 0.001 * i, 0.005, 0.008));
  EXPECT_EQ(leastDistance(pairs, 0.01), 0.02);
  pairs.push_back(pairOf(0.011, 0.005, 0.02));
  EXPECT_EQ(leastDistance(pairs, 0.01), 0.02);
  pairs.push_back(pairOf(0.01, 0.02, 0.001));
  EXPECT_EQ(leastDistance(pairs, 0.01), 0.02);
  EXPECT_FALSE(leastDistance(pairs, 0.004));
  pairs.resize(58);
  EXPECT_FALSE(leastDistance(pairs, 0.01));
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
    EXPECT_LE(pair.force_error, std::max(errors.force[0], errors.force[1]) * (1.0 + 1e-6));
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
