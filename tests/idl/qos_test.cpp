// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "palpate/idl/reader.h"
#include "palpate/idl/tap.h"
#include "palpate/idl/writer.h"
#include "palpate/testing/test_domain.h"

namespace palpate::dds {
namespace {

using namespace std::chrono_literals;

struct Policies {
  dds_reliability_kind_t reliability;
  dds_durability_kind_t durability;
  std::int32_t depth;
};

// What an entity asks for or offers beyond DDS's defaults.
Policies policiesOf(dds_entity_t entity) {
  const QosPtr qos(dds_create_qos());
  EXPECT_EQ(dds_get_qos(entity, qos.get()), DDS_RETCODE_OK);
  Policies p{};
  dds_duration_t blocking = 0, deadline = 0, lease = 0;
  dds_history_kind_t history{};
  dds_liveliness_kind_t liveliness{};
  EXPECT_TRUE(dds_qget_reliability(qos.get(), &p.reliability, &blocking));
  EXPECT_TRUE(dds_qget_durability(qos.get(), &p.durability));
  EXPECT_TRUE(dds_qget_history(qos.get(), &history, &p.depth));
  EXPECT_EQ(history, DDS_HISTORY_KEEP_LAST);
  EXPECT_TRUE(dds_qget_deadline(qos.get(), &deadline));
  EXPECT_EQ(deadline, DDS_INFINITY);
  EXPECT_TRUE(dds_qget_liveliness(qos.get(), &liveliness, &lease));
  EXPECT_EQ(lease, DDS_INFINITY);
  return p;
}

template <class T>
void expectPolicies(const Policies& writers, const Policies& readers) {
  const Participant participant(palpate::testing::exclusiveDomain());
  const Writer<T> writer(participant);
  const Reader<T> reader(participant);
  for (const auto& [entity, wanted] :
       {std::pair(writer.handle(), writers), std::pair(reader.handle(), readers)}) {
    const Policies found = policiesOf(entity);
    EXPECT_EQ(found.reliability, wanted.reliability);
    EXPECT_EQ(found.durability, wanted.durability);
    EXPECT_EQ(found.depth, wanted.depth);
  }
  EXPECT_TRUE(writer.waitForReaders(1, 5s));
  EXPECT_EQ(writer.mismatch(), "");
  EXPECT_EQ(reader.mismatch(), "");
}

constexpr Policies kBestEffort{DDS_RELIABILITY_BEST_EFFORT, DDS_DURABILITY_VOLATILE, 1};
constexpr Policies kReliable{DDS_RELIABILITY_RELIABLE, DDS_DURABILITY_VOLATILE, 1};
constexpr Policies kKept{DDS_RELIABILITY_RELIABLE, DDS_DURABILITY_TRANSIENT_LOCAL, 1};

TEST(Qos, PoseAndForceAreOfferedReliableAndReadBestEffort) {
  expectPolicies<ToolPose>(kReliable, kBestEffort);
  expectPolicies<ToolForce>(kReliable, kBestEffort);
}
TEST(Qos, DisplacementIsBestEffortKeepLastOne) {
  expectPolicies<SurfaceDisplacement>(kBestEffort, kBestEffort);
}
TEST(Qos, SurfaceAndStatusAreLatched) {
  expectPolicies<SurfaceMesh>(kKept, kKept);
  expectPolicies<ServerStatus>(kKept, kKept);
}

TEST(Qos, RequestsAndAnswersWaitToBeTaken) {
  constexpr Policies kRequest{DDS_RELIABILITY_RELIABLE, DDS_DURABILITY_VOLATILE, kQueuedRequests};
  constexpr Policies kAnswer{DDS_RELIABILITY_RELIABLE, DDS_DURABILITY_TRANSIENT_LOCAL, kQueuedRequests};
  expectPolicies<ParameterRequest>(kRequest, kRequest);
  expectPolicies<ServerParameters>(kAnswer, kAnswer);
}

// Another's writer and reader, made without any QoS.
template <class T>
struct Stranger {
  Participant participant{palpate::testing::exclusiveDomain()};
  Topic<T> topic{participant};
  Entity writer{dds_create_writer(participant.handle(), topic.handle(), nullptr, nullptr)};
  Entity reader{dds_create_reader(participant.handle(), topic.handle(), nullptr, nullptr)};
};

template <class T>
void expectReadByAStranger() {
  const Participant participant(palpate::testing::exclusiveDomain());
  const Writer<T> writer(participant);
  const Stranger<T> stranger;
  EXPECT_TRUE(writer.waitForReaders(1, 5s)) << TopicTraits<T>::kName << ": " << writer.mismatch();
}

TEST(Qos, AReaderWithoutQosHearsTheServer) {
  expectReadByAStranger<ToolForce>();
  expectReadByAStranger<SurfaceDisplacement>();
  expectReadByAStranger<SurfaceMesh>();
  expectReadByAStranger<ServerStatus>();
  expectReadByAStranger<ServerParameters>();
}

template <class T>
void expectWrittenByAStranger() {
  const Participant participant(palpate::testing::exclusiveDomain());
  const Reader<T> reader(participant);
  const Stranger<T> stranger;
  EXPECT_TRUE(reader.waitForWriters(1, 5s)) << TopicTraits<T>::kName << ": " << reader.mismatch();
}

TEST(Qos, AWriterWithoutQosIsHeardByTheServer) {
  expectWrittenByAStranger<ToolPose>();
  expectWrittenByAStranger<ParameterRequest>();
  expectWrittenByAStranger<ToolAnnouncement>();
}

TEST(Qos, AReaderThatWantsForcesReliablyGetsThem) {
  const Participant participant(palpate::testing::exclusiveDomain());
  const Writer<ToolForce> writer(participant);
  const Topic<ToolForce> topic(participant);
  const QosPtr qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  const Entity reader(dds_create_reader(participant.handle(), topic.handle(), qos.get(), nullptr));
  EXPECT_TRUE(writer.waitForReaders(1, 5s)) << writer.mismatch();
}

TEST(Qos, TopicNamesAreThoseOfTheDesign) {
  EXPECT_STREQ(TopicTraits<ToolPose>::kName, "palpate/tool/measured_cp");
  EXPECT_STREQ(TopicTraits<ToolForce>::kName, "palpate/tool/servo_cf");
  EXPECT_STREQ(TopicTraits<SurfaceDisplacement>::kName, "palpate/organ/displacement");
  EXPECT_STREQ(TopicTraits<SurfaceMesh>::kName, "palpate/organ/surface");
  EXPECT_STREQ(TopicTraits<ServerStatus>::kName, "palpate/server/status");
  EXPECT_STREQ(TopicTraits<ParameterRequest>::kName, "palpate/server/parameter_request");
  EXPECT_STREQ(TopicTraits<ServerParameters>::kName, "palpate/server/parameters");
  EXPECT_STREQ(TopicTraits<ToolAnnouncement>::kName, "palpate/tool/announcement");
}

TEST(Qos, AFloodOfIdsThatNobodyTakesHoldsUpNoReliableWriter) {
  const Participant participant(palpate::testing::exclusiveDomain());
  Writer<ServerStatus> writer(participant);
  const Reader<ServerStatus> reader(participant);
  ASSERT_TRUE(writer.waitForReaders(1, 5s));
  ServerStatus status{};
  for (status.server_id = 0; status.server_id < 1100; ++status.server_id)
    ASSERT_TRUE(writer.write(status)) << "the reader refused id " << status.server_id;
}

TEST(Qos, ABestEffortReaderHoldsABoundedNumberOfInstances) {
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

TEST(Qos, ATapHearsAWriterWithoutQosAfterAFloodOfDisposesAndKeepsFewOfThem) {
  const Participant participant(palpate::testing::exclusiveDomain());
  std::atomic<std::uint32_t> heard{0};
  const Tap<ServerStatus> tap(
      participant,
      [](const ServerStatus& status, WriterId, void* id) noexcept {
        *static_cast<std::atomic<std::uint32_t>*>(id) = status.server_id;
      },
      &heard);
  const Stranger<ServerStatus> stranger;
  ASSERT_TRUE(tap.waitForWriters(1, 5s)) << tap.mismatch();
  ServerStatus status{};
  for (status.server_id = 1; status.server_id < 2 * kMaxInstances; ++status.server_id)
    (void)dds_dispose(stranger.writer.handle(), &status);
  (void)dds_write(stranger.writer.handle(), &status);
  for (int i = 0; i < 500 && heard != status.server_id; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(heard, status.server_id);
  const QosPtr qos(dds_create_qos());
  ASSERT_EQ(dds_get_qos(tap.handle(), qos.get()), DDS_RETCODE_OK);
  std::int32_t samples = 0, instances = 0, each = 0;
  ASSERT_TRUE(dds_qget_resource_limits(qos.get(), &samples, &instances, &each));
  EXPECT_EQ(instances, kMaxInstances);
}

}  // namespace
}  // namespace palpate::dds
