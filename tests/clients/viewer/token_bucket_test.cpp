// SPDX-License-Identifier: Apache-2.0
#include "token_bucket.h"

#include <gtest/gtest.h>

namespace palpate::viewer {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(TokenBucket, LetsItsRateThroughAndAFloodNot) {
  TokenBucket bucket(400.0, 400.0);
  std::int64_t now = kMs;
  for (int i = 0; i < 4000; ++i, now += 4 * kMs)
    ASSERT_TRUE(bucket.take(now)) << "250 a second, message " << i;
  int through = 0;
  for (int i = 0; i < 10'000; ++i, now += kMs / 10)
    through += bucket.take(now) ? 1 : 0;  // 10,000 in a second
  EXPECT_NEAR(through, 800, 5) << "what was saved, and a second's worth";
}

}  // namespace
}  // namespace palpate::viewer
