// SPDX-License-Identifier: Apache-2.0
// palpate-server as a user runs it: its own process, poses and answers over DDS.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <limits>
#include <memory>
#include <string>

#include "core/model/meta_model.h"
#include "core/response/patch_response.h"
#include "core/response/response.h"
#include "server_fixture.h"
#include "tools/modelfile/write_model.h"

namespace palpate::server::testing {
namespace {

TEST_F(ServerEndToEnd, PushesBackAndEchoesThePose) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  const dds::ToolForce& force = settled_;
  const Point& n = target_.normal;
  EXPECT_GT(dot(n, force.force), 0.0) << "the force on the tool points outward";
  double stiffness_n[3] = {0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) stiffness_n[i] += force.stiffness[3 * i + j] * n[j];
  }
  EXPECT_LT(dot(n, stiffness_n), 0.0) << "deeper pushes back harder";
  EXPECT_EQ(force.state, dds::tool_state::kStick);
  EXPECT_EQ(force.flags, dds::flag::kInContact);
  EXPECT_GT(force.pose_seq, 0U);
  EXPECT_GT(force.pose_stamp_ns, 0);
  EXPECT_NEAR(force.penetration, 0.001, 1e-4);
  EXPECT_EQ(client_->waitForDisplacement(1e-4), 3 * target_.nodes);
}

// As long as it may be, and as many keys as there is room for.
TEST_F(ServerEndToEnd, ACertificateThatIsMadeToCostTimeDelaysNoStart) {
  modelfile::ModelData data = palpate::testing::syntheticModel();
  std::string& text = data.attributes.certificate;
  text = "{\"\":0";
  for (int key = 0; text.size() < 65500; ++key) text += ",\"" + std::to_string(key) + "\":0";
  text += '}';
  ASSERT_LE(text.size(), 65536U);
  modelfile::writeModel(model_, data);
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  EXPECT_NE(
      server_->log().find("not certified: the certificate in the file has a form that this program does "
                          "not know\n"),
      std::string::npos)
      << server_->log();
}

// A model that is driven by force is searched for the force; the client sees no difference.
TEST_F(ServerEndToEnd, AForceModelAnswersAPressWithTheForceThatGivesTheDisplacement) {
  palpate::testing::writeSyntheticModel(model_, {.parameters = Parameters::kForce});
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  const dds::ToolForce& force = settled_;
  EXPECT_EQ(force.flags, dds::flag::kInContact);
  const MetaModel model = MetaModel::load(model_);
  const Vec3 anchor(force.anchor[0], force.anchor[1], force.anchor[2]);
  const Vec3 d(force.displacement[0], force.displacement[1], force.displacement[2]);
  Response out;
  ASSERT_EQ(respond(model, model.surface().closestPoint(anchor).s, d, out), ResponseStatus::kOk);
  const Vec3 on_tool(force.force[0], force.force[1], force.force[2]);
  EXPECT_GT(dot(target_.normal, force.force), 0.0);
  EXPECT_LT((on_tool + out.force).norm(), 1e-6 * out.force.norm());
  EXPECT_NEAR(force.domain_radius, out.domain_radius, 1e-9);
  EXPECT_EQ(client_->waitForDisplacement(1e-5), 3 * target_.nodes);
}

TEST_F(ServerEndToEnd, ALevelModelAnswersAPressAlongItsLoad) {
  palpate::testing::writeSyntheticModel(model_, {.parameters = Parameters::kLevel});
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  const dds::ToolForce& force = settled_;
  EXPECT_EQ(force.flags, dds::flag::kInContact);
  EXPECT_NEAR(force.force[0], 0.0, 1e-12);
  EXPECT_NEAR(force.force[1] * 0.8, -force.force[2] * 0.6, 1e-9) << "the load is along (0, 0.6, -0.8)";
  EXPECT_GT(force.force[2], 0.0);
}

TEST_F(ServerEndToEnd, EveryTickIsAnsweredOnceAndInOrder) {
  ASSERT_NO_FATAL_FAILURE(start());
  client_->startSending(atDepth(0.001));
  ASSERT_TRUE(client_->waitFor([](const dds::ToolForce& f) { return f.seq > 0; }).has_value());
  // Best effort may lose samples while the machine stands still; a server that skips loses them every time.
  std::uint64_t lost = 1;
  for (int attempt = 0; attempt < 5 && lost > 0; ++attempt) {
    client_->forget();
    pause(500);
    const auto forces = client_->forces();
    ASSERT_GT(forces.size(), 10U);
    for (std::size_t i = 1; i < forces.size(); ++i) {
      ASSERT_GT(forces[i].seq, forces[i - 1].seq);
      ASSERT_GT(forces[i].stamp_ns, forces[i - 1].stamp_ns);
      ASSERT_GE(forces[i].pose_seq, forces[i - 1].pose_seq);
    }
    lost = gaps(forces);
  }
  EXPECT_EQ(lost, 0U);
}

TEST_F(ServerEndToEnd, ForceFallsSteadilyToZeroWhenPosesStop) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  const double held = sizeOf(settled_.force);
  client_->stopSending();
  client_->forget();
  pause(200);
  const auto forces = client_->forces();
  ASSERT_GT(forces.size(), 20U);
  // The stale_timeout is 20 ms and zero comes after 50 ms: the steepest fall is held / 30 ms.
  for (std::size_t i = 1; i < forces.size(); ++i) {
    const double ms = static_cast<double>(forces[i].stamp_ns - forces[i - 1].stamp_ns) / kMs;
    const double fall = sizeOf(forces[i - 1].force) - sizeOf(forces[i].force);
    EXPECT_GE(fall, -1e-9) << "rises without a pose";
    EXPECT_LE(fall, held * (0.05 + 0.05 * ms)) << "falls abruptly";
  }
  EXPECT_EQ(sizeOf(forces.back().force), 0.0);
  EXPECT_NE(forces.back().flags & dds::flag::kStalePose, 0U);
  const auto zero =
      std::find_if(forces.begin(), forces.end(), [](const auto& f) { return sizeOf(f.force) == 0.0; });
  // 51 ms after the last pose; one period more for the pose that came after forget(), some for the tick's own
  // grid.
  EXPECT_LE(zero->stamp_ns - forces.front().stamp_ns, 55 * kMs + static_cast<std::int64_t>(zero->wakeup_ns));
}

TEST_F(ServerEndToEnd, SurvivesPosesThatAreNoPoses) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  client_->stopSending();
  dds::ToolPose bad = client_->poseAt(atDepth(0.001));
  bad.position[1] = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 5; ++i, pause(2)) client_->send(bad);
  EXPECT_TRUE(
      client_->waitFor([](const auto& f) { return (f.flags & dds::flag::kNonFinitePose) != 0; }).has_value());
  bad = client_->poseAt(atDepth(0.001));
  bad.orientation[3] = 2.0;
  for (int i = 0; i < 5; ++i, pause(2)) client_->send(bad);
  EXPECT_TRUE(client_->waitFor([](const auto& f) { return (f.flags & dds::flag::kNonUnitQuaternion) != 0; })
                  .has_value());
  bad = client_->poseAt({1e300, -1e300, 1e308});
  for (int i = 0; i < 5; ++i, pause(2)) client_->send(bad);
  const auto answers = client_->forces();
  ASSERT_FALSE(answers.empty());
  for (const dds::ToolForce& force : answers) ASSERT_TRUE(isFinite(force));
  EXPECT_TRUE(client_->waitForStatus([](const auto& s) { return s.rejected_poses >= 2; }).has_value());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  EXPECT_GT(dot(target_.normal, settled_.force), 0.0) << "a good pose is answered again";
}

TEST_F(ServerEndToEnd, ClampsAndFlagsWhatLiesBeyondTheDomain) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.02));
  const dds::ToolForce& force = settled_;
  EXPECT_NE(force.flags & dds::flag::kBeyondDomain, 0U);
  EXPECT_LE(sizeOf(force.displacement), 2.0 * force.domain_radius * (1.0 + 1e-9));  // here that is r_max
  EXPECT_GT(sizeOf(force.displacement), force.domain_radius);
  EXPECT_GT(force.penetration, force.domain_radius);
  EXPECT_LE(sizeOf(force.force), 3.3 * (1.0 + 1e-9));
}

TEST_F(ServerEndToEnd, CutsTheForceToTheLimit) {
  ASSERT_NO_FATAL_FAILURE(start({"--force-limit", "0.01"}));
  ASSERT_NO_FATAL_FAILURE(press(0.002));
  const dds::ToolForce& force = settled_;
  EXPECT_NE(force.flags & dds::flag::kForceLimited, 0U);
  EXPECT_NEAR(sizeOf(force.force), 0.01, 1e-6);
}

TEST_F(ServerEndToEnd, AnswersTwoToolsEachWithItsOwnCounter) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  TestClient second(domain_, 3);
  ASSERT_TRUE(second.connect());
  second.startSending(along(target_.position, target_.normal, 0.5));
  const auto answer = second.waitFor([](const dds::ToolForce& f) { return f.seq >= 20; });
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->tool_id, 3U);
  EXPECT_EQ(sizeOf(answer->force), 0.0) << "far away";
  EXPECT_GT(client_->forces().back().seq, answer->seq);
  EXPECT_GT(dot(target_.normal, client_->forces().back().force), 0.0) << "the first tool still presses";
}

TEST_F(ServerEndToEnd, CountsPosesThatWereSupersededOrOutOfOrder) {
  ASSERT_NO_FATAL_FAILURE(start({"--rate", "50"}));
  for (int i = 0; i < 50; ++i) client_->send(client_->poseAt(atDepth(-0.01)));
  EXPECT_TRUE(client_->waitFor([](const auto& f) { return f.superseded > 0; }).has_value());
  pause(60);
  dds::ToolPose early = client_->poseAt(atDepth(-0.01));
  early.seq = 1;
  client_->send(early);
  EXPECT_TRUE(client_->waitFor([](const auto& f) { return (f.flags & dds::flag::kPoseOutOfOrder) != 0; })
                  .has_value());
  EXPECT_TRUE(client_->waitForStatus([](const auto& s) { return s.superseded > 0 && s.unordered_poses > 0; })
                  .has_value());
}

TEST_F(ServerEndToEnd, TellsItsStateAboutOnceASecond) {
  ASSERT_NO_FATAL_FAILURE(start({"--tip-radius",       "0.004", "--organ-id",    "5",
                                 "--server-id",        "6",     "--realtime",    "off",
                                 "--force-limit",      "5",     "--device",      "desktop",
                                 "--coupling",         "450",   "--friction",    "0.2",
                                 "--force-rate-limit", "inf",   "--speed-limit", "3",
                                 "--youngs-modulus",   "5e4",   "--tools",       "3"}));
  const auto status = client_->waitForStatus([](const auto& s) { return s.ticks > 100; });
  ASSERT_TRUE(status.has_value());
  EXPECT_EQ(status->server_id, 6U);
  EXPECT_EQ(status->organ_id, 5U);
  EXPECT_EQ(status->state, dds::server_state::kRunning);
  EXPECT_EQ(status->tip_radius[0], 0.004);
  EXPECT_STREQ(status->device, "desktop");
  EXPECT_EQ(status->force_limit, 5.0) << "what is named wins over what the device brings";
  EXPECT_EQ(status->coupling_stiffness, 450.0);
  EXPECT_EQ(status->coupling_damping, 1.5);
  EXPECT_EQ(status->friction, 0.2);
  EXPECT_EQ(status->youngs_modulus, 50e3);
  EXPECT_TRUE(std::isinf(status->force_rate_limit));
  EXPECT_EQ(status->speed_limit, 3.0);
  EXPECT_EQ(status->tools, 3U);
  EXPECT_EQ(status->rate_hz, 1000.0);
  EXPECT_FALSE(status->realtime);
  EXPECT_GT(status->tick_us.p50, 0.0);
  EXPECT_GE(status->tick_us.count, 100U);
  const auto later = client_->waitForStatus([&](const auto& s) { return s.ticks > status->ticks; });
  EXPECT_TRUE(later.has_value());
}

class ServerStops : public ServerEndToEnd, public ::testing::WithParamInterface<int> {};

TEST_P(ServerStops, WithZeroForceLastAndExitCodeZero) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  ASSERT_GT(sizeOf(settled_.force), 0.0);
  client_->forget();
  server_->signal(GetParam());
  EXPECT_EQ(server_->waitForExit(), 0) << server_->log();
  pause(50);
  const auto forces = client_->forces();
  ASSERT_GE(forces.size(), 5U);
  for (auto last = forces.end() - 5; last != forces.end(); ++last) {
    EXPECT_EQ(sizeOf(last->force), 0.0);
    EXPECT_NE(last->flags & dds::flag::kShuttingDown, 0U);
  }
  EXPECT_TRUE(client_->waitForStatus([](const auto& s) { return s.state == dds::server_state::kStopping; })
                  .has_value());
}

// Leaves no room in a pipe: a writer waits for a reader.
void fill(int pipe_end) {
  const int flags = fcntl(pipe_end, F_GETFL);
  fcntl(pipe_end, F_SETFL, flags | O_NONBLOCK);
  while (write(pipe_end, "x", 1) == 1) {
  }
  fcntl(pipe_end, F_SETFL, flags);
}

TEST_F(ServerEndToEnd, StopsWithZeroForceWhenNobodyReadsItsLog) {
  int ends[2] = {-1, -1};
  ASSERT_EQ(pipe(ends), 0);
  log_fd_ = ends[1];
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(press(0.001));
  ASSERT_GT(sizeOf(settled_.force), 0.0);
  fill(ends[1]);
  client_->forget();
  server_->signal(SIGTERM);
  EXPECT_EQ(server_->waitForExit(std::chrono::seconds(10)), 0);
  pause(50);
  const auto forces = client_->forces();
  ASSERT_FALSE(forces.empty());
  EXPECT_EQ(sizeOf(forces.back().force), 0.0);
  EXPECT_NE(forces.back().flags & dds::flag::kShuttingDown, 0U);
  close(ends[0]);
  close(ends[1]);
}

INSTANTIATE_TEST_SUITE_P(Signals, ServerStops, ::testing::Values(SIGINT, SIGTERM));

}  // namespace
}  // namespace palpate::server::testing
