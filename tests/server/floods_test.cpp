// SPDX-License-Identifier: Apache-2.0
// What a flood of ids or requests does to a tool that behaves: nothing.
#include <gtest/gtest.h>

#include "palpate/testing/run_program.h"
#include "server_fixture.h"

namespace palpate::server::testing {
namespace {

class Floods : public ServerEndToEnd {
 protected:
  // Presses; runs `flood` several times meanwhile, whose writer stays; the answers go on and the force stays.
  template <class Flood>
  void pressUnder(Flood flood) {
    ASSERT_NO_FATAL_FAILURE(start());
    ASSERT_NO_FATAL_FAILURE(press(0.001));
    const double before = sizeOf(settled_.force);
    ASSERT_TRUE(flood.writer.waitForReaders(1, std::chrono::seconds(5)));
    client_->forget();
    for (int i = 0; i < 10; ++i, pause(50)) flood.run();
    const auto forces = client_->forces();
    EXPECT_GT(forces.size(), 300U);
    double least = 1e9;
    for (const dds::ToolForce& force : forces) least = std::min(least, sizeOf(force.force));
    EXPECT_GT(least, 0.5 * before);
    ASSERT_NO_FATAL_FAILURE(settle());
    EXPECT_NEAR(sizeOf(settled_.force), before, 1e-3 * before) << server_->log();
  }
};

struct Requests {
  explicit Requests(std::uint32_t domain) : participant(domain), writer(participant) {}
  dds::Participant participant;
  dds::Writer<dds::ParameterRequest> writer;
};

// Sends disposes of instances instead of data.
template <class T>
void dispose(dds::Writer<T>& writer, const T& sample) {
  (void)dds_dispose(writer.handle(), &sample);
}

TEST_F(Floods, OfRequestsToOtherServersTouchNoForce) {
  struct Flood : Requests {
    using Requests::Requests;
    void run() {
      dds::ParameterRequest request{};
      request.request_id = 1;
      for (request.server_id = 1; request.server_id <= 1100; ++request.server_id) (void)writer.write(request);
    }
  };
  pressUnder(Flood(domain_));
  EXPECT_TRUE(logs("parameter requests for other servers")) << server_->log();
}

TEST_F(Floods, OfRequestsToThisServerAreDroppedAndOneAfterThemIsAnswered) {
  struct Flood : Requests {
    using Requests::Requests;
    void run() {
      dds::ParameterRequest request{};
      for (request.request_id = 1; request.request_id <= 1000; ++request.request_id) {
        (void)writer.write(request);
        dispose(writer, request);
      }
    }
  };
  pressUnder(Flood(domain_));
  EXPECT_TRUE(logs("dropped so far, more than 50 came in a second")) << server_->log();
  const auto status = client_->waitForStatus([](const auto& s) { return s.surplus_requests > 1000; });
  EXPECT_TRUE(status.has_value());
  const auto result = palpate::testing::runProgram(
      "palpate-parameters", {"--friction", "0.1", "--domain", std::to_string(domain_), "--wait", "10"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

}  // namespace
}  // namespace palpate::server::testing
