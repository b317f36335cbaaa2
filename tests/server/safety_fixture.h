// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "palpate/testing/timed_tests.h"
#include "server_fixture.h"

namespace palpate::server::testing {

inline constexpr double kForceLimit = 3.3;  // N, the default

class Safety : public ServerEndToEnd {
 protected:
  [[nodiscard]] bool sees(std::uint32_t flag) const {
    return client_->waitFor([&](const auto& f) { return (f.flags & flag) != 0; }).has_value();
  }

  // There were answers, and none so far was above the limit, or no number.
  void expectBounded(double limit = kForceLimit) const {
    const auto forces = client_->forces();
    ASSERT_FALSE(forces.empty());
    for (const dds::ToolForce& force : forces) {
      if (isFinite(force) && sizeOf(force.force) <= limit * (1.0 + 1e-9)) continue;
      palpate::testing::countAlways();
      FAIL() << "a force of " << sizeOf(force.force) << " N, where " << limit << " is the limit";
    }
  }

  // The server goes on: a good press is pushed back.
  void expectAlive() {
    client_->stopSending();
    pause(60);  // whatever was done, its poses are stale
    ASSERT_NO_FATAL_FAILURE(press(0.001)) << server_->log();
    EXPECT_GT(dot(target_.normal, settled_.force), 0.05);
    EXPECT_TRUE(server_->running());
  }

  // Like startSending() at a pose that is bad in its own way.
  void sendFor(int milliseconds, const dds::ToolPose& pose) {
    for (int i = 0; i < milliseconds; ++i, pause(1)) client_->send(pose);
  }
};

}  // namespace palpate::server::testing
