// SPDX-License-Identifier: Apache-2.0
// Several servers on one domain, played by the test.
#include "organ_feed.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <thread>

#include "../small_surface.h"
#include "palpate/client/error.h"
#include "palpate/idl/writer.h"
#include "palpate/rt/clock.h"
#include "palpate/testing/test_domain.h"

namespace palpate::viewer {
namespace {

constexpr double kNeverTwice = 0.1;  // fields a second: one is looked at in a test's time

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

  void sayStatus(std::uint32_t server_id, std::uint32_t organ_id, const char* model,
                 std::uint32_t state = dds::server_state::kRunning) {
    dds::ServerStatus status{};
    status.server_id = server_id;
    status.organ_id = organ_id;
    status.state = state;
    dds::assignText(status.model_id, model);
    ASSERT_TRUE(statuses_.write(status));
  }
  void saySurface(std::uint32_t organ_id, const char* model) {
    testing::SmallSurface small;
    small.model_id = model;
    dds::SurfaceMesh message = small.message();
    message.organ_id = organ_id;
    ASSERT_TRUE(surfaces_.write(message));
  }
  void sayField(std::uint32_t organ_id, const char* model, std::uint64_t seq) {
    std::vector<float> u(15, 0.001F);
    dds::SurfaceDisplacement field{};
    field.organ_id = organ_id;
    dds::assignText(field.model_id, model);
    field.seq = seq;
    field.displacement = {15, 15, u.data(), false};
    ASSERT_TRUE(fields_.write(field));
  }
  void sayParameters(std::uint32_t server_id, double model_youngs_modulus) {
    dds::ServerParameters parameters{};
    parameters.server_id = server_id;
    parameters.model_youngs_modulus = model_youngs_modulus;
    ASSERT_TRUE(parameters_.write(parameters));
  }

  dds::Participant participant_{testing::exclusiveDomain()};
  dds::Writer<dds::ServerStatus> statuses_{participant_};
  dds::Writer<dds::SurfaceMesh> surfaces_{participant_};
  dds::Writer<dds::ServerParameters> parameters_{participant_};
  dds::Writer<dds::SurfaceDisplacement> fields_{participant_};
  dds::Writer<dds::ToolForce> forces_{participant_};
  dds::Writer<dds::ToolPose> poses_{participant_};
  OrganFeed feed_{participant_, kNeverTwice, [](void*) noexcept {}, nullptr};
};

TEST_F(FeedOfManyServers, AnotherModelOfTheSameOrganDoesNotHideTheOneThatIsFollowed) {
  sayStatus(1, 0, "aa");
  ASSERT_TRUE(until([&] { return state() == "waiting"; }));
  saySurface(0, "aa");
  saySurface(0, "bb");  // before the first was looked at, and on the same DDS instance
  EXPECT_TRUE(until([&] { return state() == "serving"; })) << feed_.state(rt::monotonicNow()).text;
  ASSERT_NE(feed_.surface(), nullptr);
  EXPECT_EQ(feed_.surface()->model_id, "aa");
  sayStatus(1, 0, "aa", dds::server_state::kStopping);
  sayStatus(2, 0, "bb");
  EXPECT_TRUE(until([&] { return feed_.surface()->model_id == "bb" && state() == "serving"; }))
      << "the other server's surface, which came once";
}

TEST_F(FeedOfManyServers, OtherOrgansHoweverManyDoNotHideTheOneThatIsFollowed) {
  sayStatus(1, 500, "aa");
  saySurface(500, "aa");
  ASSERT_TRUE(until([&] { return state() == "serving"; }));
  for (std::uint32_t organ = 0; organ < 3 * Surfaces::kMostKept; ++organ) {
    saySurface(organ, "cc");
    (void)feed_.poll(rt::monotonicNow(), 0);
  }
  EXPECT_FALSE(until([&] { return state() != "serving"; }));
}

TEST_F(FeedOfManyServers, TheNextServersParametersAreKnownThoughTheyCameBeforeItWasFollowed) {
  sayStatus(1, 0, "aa");
  sayParameters(1, 100e3);
  ASSERT_TRUE(until([&] { return feed_.parameters().has_value(); }));
  sayParameters(2, 300e3);
  bool came = false;
  ASSERT_TRUE(until([&] {
    for (const dds::ServerParameters& parameters : feed_.newParameters()) came |= parameters.server_id == 2;
    return came;
  }));
  ASSERT_TRUE(feed_.parameters());
  EXPECT_EQ(feed_.parameters()->model_youngs_modulus, 100e3);
  sayStatus(1, 0, "aa", dds::server_state::kStopping);
  sayStatus(2, 0, "bb");
  ASSERT_TRUE(until([&] { return feed_.watch().status()->server_id == 2; }));
  ASSERT_TRUE(feed_.parameters());
  EXPECT_EQ(feed_.parameters()->model_youngs_modulus, 300e3);
}

TEST_F(FeedOfManyServers, AServerThatSaidNoParametersHasNotThoseOfTheOneBefore) {
  sayStatus(1, 0, "aa");
  sayParameters(1, 100e3);
  ASSERT_TRUE(until([&] { return feed_.parameters().has_value(); }));
  sayStatus(1, 0, "aa", dds::server_state::kStopping);
  sayStatus(2, 0, "bb");
  ASSERT_TRUE(until([&] { return feed_.watch().status()->server_id == 2; }));
  EXPECT_FALSE(feed_.parameters());
}

TEST_F(FeedOfManyServers, NonFiniteAnswersAndPosesAreNotShown) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  const auto answer = [&](std::uint32_t tool_id, const std::function<void(dds::ToolForce&)>& spoil) {
    dds::ToolForce message{};
    message.tool_id = tool_id;
    message.force[1] = 1.0;
    spoil(message);
    ASSERT_TRUE(forces_.write(message));
  };
  const auto pose = [&](double x) {
    dds::ToolPose message{};
    message.tool_id = 3;
    message.position[0] = x;
    ASSERT_TRUE(poses_.write(message));
  };
  for (const double wrong : {nan, -infinity, 1e300, 3e38}) {  // three of the last are no float
    answer(0, [&](dds::ToolForce& f) { f.force[1] = wrong; });
    answer(0, [&](dds::ToolForce& f) { f.stiffness[8] = wrong; });
    answer(1, [&](dds::ToolForce& f) { f.anchor[2] = wrong; });
    answer(1, [&](dds::ToolForce& f) { f.proxy[0] = wrong; });
    answer(2, [&](dds::ToolForce& f) { f.penetration = wrong; });
    answer(2, [&](dds::ToolForce& f) { f.domain_radius = wrong; });
  }
  const auto good = [](dds::ToolForce&) {};
  pose(0.25);
  const auto shown = [&](std::uint32_t id) { return feed_.tool(id, rt::monotonicNow()); };
  ASSERT_TRUE(until([&] {
    answer(3, good);
    return shown(3) != nullptr && shown(3)->tip_known;
  }));
  pose(nan);
  pose(1e300);
  EXPECT_FALSE(until([&] {
    answer(3, good);
    return shown(3) == nullptr || shown(3)->tip[0] != 0.25;
  }));
  for (const std::uint32_t id : {0U, 1U, 2U}) EXPECT_EQ(shown(id), nullptr) << id;
}

TEST_F(FeedOfManyServers, FieldsOfOtherOrgansAndModelsDoNotSpendThePace) {
  sayStatus(1, 0, "aa");
  saySurface(0, "aa");
  ASSERT_TRUE(until([&] { return state() == "serving"; }));
  for (std::uint64_t i = 1; i <= 5; ++i) {
    sayField(1, "aa", i);
    sayField(0, "bb", i);
  }
  sayField(0, "aa", 77);
  ASSERT_TRUE(until([&] { return feed_.field() != nullptr; }));
  EXPECT_EQ(feed_.field()->seq, 77U);
  EXPECT_EQ(feed_.droppedFields(), 0U);
}

TEST(Surfaces, ASurfaceTooLargeToShowIsRefusedUnread) {
  testing::SmallSurface small;
  dds::SurfaceMesh positions = small.message();
  positions.positions = {3'000'003, 3'000'003, nullptr, false};
  EXPECT_THROW((void)Surfaces::bounded(positions), client::ClientError);
  dds::SurfaceMesh triangles = small.message();
  triangles.triangles = {3'000'003, 3'000'003, nullptr, false};
  EXPECT_THROW((void)Surfaces::bounded(triangles), client::ClientError);
  EXPECT_EQ(Surfaces::bounded(small.message()).positions.size(), 5U);
}

}  // namespace
}  // namespace palpate::viewer
