// SPDX-License-Identifier: Apache-2.0
// Several servers on one domain, played by the test.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <thread>

#include "../small_surface.h"
#include "organ_feed.h"
#include "palpate/client/error.h"
#include "palpate/idl/writer.h"
#include "palpate/rt/clock.h"
#include "palpate/testing/test_domain.h"

namespace palpate::viewer {

inline constexpr double kNeverTwice = 0.1;  // fields a second: one is looked at in a test's time

class FeedOfManyServers : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < 1000 && !matched(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(matched());
  }
  [[nodiscard]] bool matched() const {
    return statuses_.matched() > 0 && surfaces_.matched() > 0 && parameters_.matched() > 0 &&
           fields_.matched() > 0 && forces_.matched() > 0 && poses_.matched() > 0;
  }
  // Polls until the condition holds, or the time is over.
  bool until(const std::function<bool()>& so) {
    for (int i = 0; i < 400; ++i) {
      (void)feed_.poll(rt::monotonicNow(), 0);
      if (so()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
  [[nodiscard]] std::string state() const { return feed_.state(rt::monotonicNow()).name; }

  // One run of a server, on the wire.
  struct Run {
    std::uint32_t server_id{0};
    std::uint64_t session{1};
    const char* model{"aa"};
    std::uint32_t organ_id{0};
  };
  void sayStatus(const Run& run, std::uint32_t state = dds::server_state::kRunning) {
    dds::ServerStatus status{};
    status.server_id = run.server_id;
    status.session = run.session;
    status.answers_any = true;
    status.organ_id = run.organ_id;
    status.state = state;
    dds::assignText(status.model_id, run.model);
    dds::assignText(status.host, "bench");
    ASSERT_TRUE(statuses_.write(status));
  }
  void saySurface(const Run& run, double width = 0.1) {
    testing::SmallSurface small;
    small.model_id = run.model;
    small.positions[3] = width;
    dds::SurfaceMesh message = small.message();
    message.session = run.session;
    message.organ_id = run.organ_id;
    ASSERT_TRUE(surfaces_.write(message));
  }
  void sayField(const Run& run, std::uint64_t seq) {
    std::vector<float> u(15, 0.001F);
    dds::SurfaceDisplacement field{};
    field.session = run.session;
    field.organ_id = run.organ_id;
    dds::assignText(field.model_id, run.model);
    field.seq = seq;
    field.displacement = {15, 15, u.data(), false};
    ASSERT_TRUE(fields_.write(field));
  }
  void sayForce(const Run& run, double newton) {
    dds::ToolForce force{};
    force.server_id = run.server_id;
    force.session = run.session;
    force.tool_id = 1;
    force.force[0] = newton;
    ASSERT_TRUE(forces_.write(force));
  }
  void sayParameters(const Run& run, double model_youngs_modulus) {
    dds::ServerParameters parameters{};
    parameters.server_id = run.server_id;
    parameters.session = run.session;
    parameters.model_youngs_modulus = model_youngs_modulus;
    ASSERT_TRUE(parameters_.write(parameters));
  }
  void sayAll(const Run& run) {
    sayStatus(run);
    saySurface(run);
    sayParameters(run, 100e3);
    ASSERT_TRUE(until([&] { return state() == "serving" && feed_.parameters(); }));
  }
  [[nodiscard]] double shownForce() const {
    const auto* tool = feed_.tool(1, rt::monotonicNow());
    return tool ? tool->force.force[0] : 0.0;
  }

  dds::Participant participant_{testing::exclusiveDomain()};
  dds::Writer<dds::ServerStatus> statuses_{participant_};
  dds::Writer<dds::SurfaceMesh> surfaces_{participant_};
  dds::Writer<dds::ServerParameters> parameters_{participant_};
  dds::Writer<dds::SurfaceDisplacement> fields_{participant_};
  dds::Writer<dds::ToolForce> forces_{participant_};
  dds::Writer<dds::ToolPose> poses_{participant_};
  OrganFeed feed_{participant_, {}, kNeverTwice, [](void*) noexcept {}, nullptr};
};

}  // namespace palpate::viewer
