// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "palpate/idl/reader.h"
#include "palpate/idl/writer.h"
#include "palpate/testing/test_domain.h"

namespace palpate::dds {
namespace {

using namespace std::chrono_literals;

struct Policies {
  dds_reliability_kind_t reliability;
  dds_durability_kind_t durability;
  dds_history_kind_t history;
  std::int32_t depth;
  dds_duration_t deadline;
  dds_liveliness_kind_t liveliness;
  dds_duration_t lease;
};

Policies policiesOf(dds_entity_t entity) {
  const QosPtr qos(dds_create_qos());
  EXPECT_EQ(dds_get_qos(entity, qos.get()), DDS_RETCODE_OK);
  Policies p{};
  dds_duration_t blocking = 0;
  EXPECT_TRUE(dds_qget_reliability(qos.get(), &p.reliability, &blocking));
  EXPECT_TRUE(dds_qget_durability(qos.get(), &p.durability));
  EXPECT_TRUE(dds_qget_history(qos.get(), &p.history, &p.depth));
  EXPECT_TRUE(dds_qget_deadline(qos.get(), &p.deadline));
  EXPECT_TRUE(dds_qget_liveliness(qos.get(), &p.liveliness, &p.lease));
  return p;
}

template <class T>
void expectOnBothEnds(void (*expect)(const Policies&)) {
  const Participant participant(palpate::testing::exclusiveDomain());
  const Writer<T> writer(participant);
  const Reader<T> reader(participant);
  expect(policiesOf(writer.handle()));
  expect(policiesOf(reader.handle()));
  EXPECT_TRUE(writer.waitForReaders(1, 5s));
  EXPECT_EQ(writer.mismatch(), "");
  EXPECT_EQ(reader.mismatch(), "");
}

void expectServo(const Policies& p) {
  EXPECT_EQ(p.reliability, DDS_RELIABILITY_BEST_EFFORT);
  EXPECT_EQ(p.history, DDS_HISTORY_KEEP_LAST);
  EXPECT_EQ(p.depth, 1);
  EXPECT_EQ(p.deadline, DDS_MSECS(5));
  EXPECT_EQ(p.liveliness, DDS_LIVELINESS_AUTOMATIC);
  EXPECT_EQ(p.lease, DDS_MSECS(50));
}
void expectField(const Policies& p) {
  EXPECT_EQ(p.reliability, DDS_RELIABILITY_BEST_EFFORT);
  EXPECT_EQ(p.durability, DDS_DURABILITY_VOLATILE);
  EXPECT_EQ(p.depth, 1);
}
void expectLatched(const Policies& p) {
  EXPECT_EQ(p.reliability, DDS_RELIABILITY_RELIABLE);
  EXPECT_EQ(p.durability, DDS_DURABILITY_TRANSIENT_LOCAL);
  EXPECT_EQ(p.history, DDS_HISTORY_KEEP_LAST);
  EXPECT_EQ(p.depth, 1);
}

TEST(Qos, PoseAndForceAreServoTopics) {
  expectOnBothEnds<ToolPose>(expectServo);
  expectOnBothEnds<ToolForce>(expectServo);
}
TEST(Qos, DisplacementIsBestEffortKeepLastOne) {
  expectOnBothEnds<SurfaceDisplacement>(expectField);
}
TEST(Qos, SurfaceAndStatusAreLatched) {
  expectOnBothEnds<SurfaceMesh>(expectLatched);
  expectOnBothEnds<ServerStatus>(expectLatched);
}

TEST(Qos, RequestsAndAnswersWaitToBeTaken) {
  expectOnBothEnds<ParameterRequest>([](const Policies& p) {
    EXPECT_EQ(p.reliability, DDS_RELIABILITY_RELIABLE);
    EXPECT_EQ(p.durability, DDS_DURABILITY_VOLATILE);
    EXPECT_EQ(p.depth, kQueuedRequests);
  });
  expectOnBothEnds<ServerParameters>([](const Policies& p) {
    EXPECT_EQ(p.reliability, DDS_RELIABILITY_RELIABLE);
    EXPECT_EQ(p.durability, DDS_DURABILITY_TRANSIENT_LOCAL);
    EXPECT_EQ(p.depth, kQueuedRequests);
  });
}

TEST(Qos, TopicNamesAreThoseOfTheDesign) {
  EXPECT_STREQ(TopicTraits<ToolPose>::kName, "palpate/tool/measured_cp");
  EXPECT_STREQ(TopicTraits<ToolForce>::kName, "palpate/tool/servo_cf");
  EXPECT_STREQ(TopicTraits<SurfaceDisplacement>::kName, "palpate/organ/displacement");
  EXPECT_STREQ(TopicTraits<SurfaceMesh>::kName, "palpate/organ/surface");
  EXPECT_STREQ(TopicTraits<ServerStatus>::kName, "palpate/server/status");
  EXPECT_STREQ(TopicTraits<ParameterRequest>::kName, "palpate/server/parameter_request");
  EXPECT_STREQ(TopicTraits<ServerParameters>::kName, "palpate/server/parameters");
}

TEST(Qos, AReaderThatAsksForMoreIsReportedByName) {
  const Participant participant(palpate::testing::exclusiveDomain());
  const Writer<ToolPose> writer(participant);
  const QosPtr qos = makeQos(QosProfile::kServo, Endpoint::kReader);
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  const Topic<ToolPose> topic(participant);
  const Entity demanding(dds_create_reader(participant.handle(), topic.handle(), qos.get(), nullptr));
  ASSERT_GT(demanding.handle(), 0);
  EXPECT_FALSE(writer.waitForReaders(1, 100ms));
  EXPECT_EQ(writer.mismatch(), "found a reader of palpate/tool/measured_cp that does not fit: reliability");
}

TEST(Qos, AReaderHoldsABoundedNumberOfInstances) {
  const Participant participant(palpate::testing::exclusiveDomain());
  Writer<ToolPose> writer(participant);
  const Reader<ToolPose> reader(participant);
  ASSERT_TRUE(writer.waitForReaders(1, 5s));
  ToolPose pose{};
  for (pose.tool_id = 0; pose.tool_id < 2 * kMaxInstances; ++pose.tool_id) (void)writer.write(pose);
  std::vector<ToolPose> got(kMaxTake);
  std::size_t total = 0;
  for (std::size_t n = 0; (n = reader.take(got)) > 0;) total += n;
  EXPECT_EQ(total, static_cast<std::size_t>(kMaxInstances));
}

}  // namespace
}  // namespace palpate::dds
