// SPDX-License-Identifier: Apache-2.0
#include <dds/ddsrt/sync.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <mutex>

namespace palpate::server {
namespace {

constexpr int kPassesOn = 32;  // glibc: PTHREAD_MUTEX_PRIO_INHERIT_NP

TEST(InheritingMutexes, ThoseThatCycloneMakesPassPrioritiesOn) {
  ddsrt_mutex_t mutex;
  ddsrt_mutex_init(&mutex);
  EXPECT_NE(mutex.mutex.__data.__kind & kPassesOn, 0);
  ddsrt_mutex_lock(&mutex);
  EXPECT_FALSE(ddsrt_mutex_trylock(&mutex));
  ddsrt_mutex_unlock(&mutex);
  ddsrt_mutex_destroy(&mutex);
}

TEST(InheritingMutexes, ThoseMadeWithAttributesAreAsTheyWereAskedFor) {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_RECURSIVE);
  pthread_mutex_t mutex;
  ASSERT_EQ(pthread_mutex_init(&mutex, &attributes), 0);
  EXPECT_EQ(mutex.__data.__kind & kPassesOn, 0);
  EXPECT_EQ(pthread_mutex_lock(&mutex), 0);
  EXPECT_EQ(pthread_mutex_lock(&mutex), 0);
  EXPECT_EQ(pthread_mutex_unlock(&mutex), 0);
  EXPECT_EQ(pthread_mutex_unlock(&mutex), 0);
  pthread_mutex_destroy(&mutex);
  pthread_mutexattr_destroy(&attributes);
}

}  // namespace
}  // namespace palpate::server
