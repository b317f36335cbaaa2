// SPDX-License-Identifier: Apache-2.0
// What the environment says, right and wrong. tests/faults/service_test.cpp plays the manager itself.
#include "palpate/server/service_manager.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

namespace palpate::server {
namespace {

using std::chrono::microseconds;

class ServiceManagerTest : public ::testing::Test {
 protected:
  ServiceManagerTest() { ::setenv("NOTIFY_SOCKET", "/run/palpate-no-such-socket", 1); }
  ~ServiceManagerTest() override {
    for (const char* const name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) ::unsetenv(name);
  }
  static microseconds patienceOf(const std::string& usec) {
    ::setenv("WATCHDOG_USEC", usec.c_str(), 1);
    return ServiceManager().patience();
  }
};

TEST_F(ServiceManagerTest, TakesItsPatienceWithinBounds) {
  EXPECT_EQ(ServiceManager().patience(), microseconds(0));
  EXPECT_EQ(patienceOf("3000000"), microseconds(3'000'000));
  EXPECT_EQ(patienceOf("1"), microseconds(10'000)) << "no look without pause";
  EXPECT_EQ(patienceOf("9223372036854775807"), std::chrono::hours(24)) << "no overflow in ns";
  for (const char* const wrong : {"", "x", "3s", "-1", "0", "1e6", "99999999999999999999"})
    EXPECT_EQ(patienceOf(wrong), microseconds(0)) << wrong;
}

TEST_F(ServiceManagerTest, DoesNotWatchForAnotherProcess) {
  ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
  EXPECT_EQ(patienceOf("3000000"), microseconds(3'000'000));
  ::setenv("WATCHDOG_PID", "1", 1);
  EXPECT_EQ(patienceOf("3000000"), microseconds(0));
}

TEST_F(ServiceManagerTest, IsNotThereWhereItsSocketHasNoName) {
  for (const std::string& wrong :
       {std::string(), std::string("/"), std::string("run/notify"), std::string(108, '/')}) {
    ::setenv("NOTIFY_SOCKET", wrong.c_str(), 1);
    EXPECT_EQ(patienceOf("3000000"), microseconds(0)) << wrong;
    ServiceManager().tell("READY=1");
  }
}

TEST_F(ServiceManagerTest, ThatIsGoneIsToldNothing) {
  ServiceManager().tell("READY=1");
}

}  // namespace
}  // namespace palpate::server
