// SPDX-License-Identifier: Apache-2.0
// One thread at a time: the contract of the lock-free parts. What threads do to them is in the stress tests.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "palpate/rt/spsc_queue.h"
#include "palpate/rt/triple_buffer.h"

namespace palpate::rt {
namespace {

TEST(TripleBuffer, ReaderFindsThePrototypeUntilSomethingIsPublished) {
  TripleBuffer<int> buffer(42);
  EXPECT_FALSE(buffer.update());
  EXPECT_EQ(buffer.front(), 42);
}

TEST(TripleBuffer, ReaderGetsTheLatestValueOnce) {
  TripleBuffer<int> buffer;
  buffer.write(1);
  buffer.write(2);
  int value = 0;
  EXPECT_TRUE(buffer.read(value));
  EXPECT_EQ(value, 2);
  value = 0;
  EXPECT_FALSE(buffer.read(value));
  EXPECT_EQ(value, 2) << "front() keeps the last value";
}

TEST(TripleBuffer, PublishSaysWhenItReplacedAnUnreadValue) {
  TripleBuffer<int> buffer;
  EXPECT_FALSE(buffer.write(1));
  EXPECT_TRUE(buffer.write(2));
  EXPECT_TRUE(buffer.update());
  EXPECT_FALSE(buffer.write(3));
}

TEST(TripleBuffer, LargeSlotsAreFilledInPlace) {
  TripleBuffer<std::vector<float>> buffer(std::vector<float>(3, 0.0F));
  const float* const memory = buffer.back().data();
  buffer.back()[1] = 5.0F;
  buffer.publish();
  ASSERT_TRUE(buffer.update());
  EXPECT_EQ(buffer.front().data(), memory) << "published without a copy";
  EXPECT_EQ(buffer.front(), (std::vector<float>{0.0F, 5.0F, 0.0F}));
}

TEST(SpscQueue, KeepsTheOrder) {
  SpscQueue<int, 4> queue;
  int value = 0;
  EXPECT_FALSE(queue.pop(value));
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(queue.push(10 * round + i));
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(queue.pop(value));
      EXPECT_EQ(value, 10 * round + i);
    }
  }
  EXPECT_FALSE(queue.pop(value));
}

TEST(SpscQueue, RefusesWhenFullAndKeepsWhatItHas) {
  SpscQueue<int, 4> queue;
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(queue.push(i));
  EXPECT_FALSE(queue.push(99));
  int value = -1;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(queue.pop(value));
    EXPECT_EQ(value, i);
  }
  EXPECT_FALSE(queue.pop(value));
  EXPECT_TRUE(queue.push(5));
}

}  // namespace
}  // namespace palpate::rt
