// SPDX-License-Identifier: Apache-2.0
#include "palpate/rt/token_bucket.h"

#include <gtest/gtest.h>

#include "palpate/rt/clock.h"

namespace palpate::rt {
namespace {

int taken(TokenBucket& bucket, std::int64_t from_ns, std::int64_t until_ns, std::int64_t every_ns) {
  int count = 0;
  for (std::int64_t now = from_ns; now < until_ns; now += every_ns) count += bucket.take(now) ? 1 : 0;
  return count;
}

TEST(TokenBucket, LetsThroughASecondsWorthAtOnceAndThenItsRate) {
  TokenBucket bucket(50, 50);
  EXPECT_EQ(taken(bucket, 0, kMs, kMs / 1000), 50);
  EXPECT_EQ(taken(bucket, kMs, 1001 * kMs, kMs / 10), 50);
}

TEST(TokenBucket, SavesNoMoreThanASecond) {
  TokenBucket bucket(50, 50);
  EXPECT_EQ(taken(bucket, 3'600'000 * kMs, 3'600'001 * kMs, kMs / 1000), 50);
}

TEST(TokenBucket, StopsNobodyWhoIsSlower) {
  TokenBucket bucket(50, 50);
  EXPECT_EQ(taken(bucket, 0, 2000 * kMs, 20 * kMs), 100);
}

TEST(TokenBucket, SavesWhatMayComeAtOnceAndNoMore) {
  TokenBucket bucket(0.5, 3);
  EXPECT_EQ(taken(bucket, 0, kMs, kMs / 10), 3);
  EXPECT_EQ(taken(bucket, kMs, 4001 * kMs, kMs), 2);
}

}  // namespace
}  // namespace palpate::rt
