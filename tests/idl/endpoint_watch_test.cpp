// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/endpoint_watch.h"

#include <final.h>  // palpate.idl with all types @final
#include <unistd.h>

#include <functional>

#include "link.h"
#include "palpate/idl/reader.h"
#include "palpate/idl/tap.h"
#include "palpate/idl/writer.h"

namespace palpate::dds {
namespace {

// Our writer and reader of poses, and one endpoint of somebody else.
class EndpointWatchTest : public ::testing::Test {
 protected:
  EndpointWatchTest() {
    watch_.add(writer_);
    watch_.add(reader_);
  }

  using Change = std::function<void(dds_qos_t*)>;
  void joinWriter(const Change& change, const dds_topic_descriptor_t& type = palpate_ToolPose_desc) {
    join(&dds_create_writer, change, type);
  }
  void joinReader(const Change& change) { join(&dds_create_reader, change, palpate_ToolPose_desc); }

  // The one line that the watch has to say, without the name of the endpoint.
  [[nodiscard]] std::string told() {
    std::vector<std::string> lines;
    (void)eventually([&] {
      const auto more = watch_.poll();
      lines.insert(lines.end(), more.begin(), more.end());
      return !lines.empty();
    });
    EXPECT_EQ(lines.size(), 1U);
    if (lines.empty()) return {};
    const std::size_t who = lines[0].find("; it is ");
    EXPECT_NE(lines[0].find(", process test_idl (" + std::to_string(getpid()) + ") on "), std::string::npos)
        << lines[0];
    return lines[0].substr(0, who);
  }

  Participant participant_{palpate::testing::exclusiveDomain()};
  Writer<ToolPose> writer_{participant_};
  Reader<ToolPose> reader_{participant_};
  EndpointWatch watch_{participant_, 20ms};

 private:
  void join(dds_entity_t (*create)(dds_entity_t, dds_entity_t, const dds_qos_t*, const dds_listener_t*),
            const Change& change, const dds_topic_descriptor_t& type) {
    const QosPtr qos(dds_create_qos());
    change(qos.get());
    topic_ = Entity(dds_create_topic(other_.handle(), &type, TopicTraits<ToolPose>::kName, nullptr, nullptr));
    endpoint_ = Entity(create(other_.handle(), topic_.handle(), qos.get(), nullptr));
    ASSERT_GT(endpoint_.handle(), 0);
  }

  Participant other_{palpate::testing::exclusiveDomain()};
  Entity topic_, endpoint_;
};

constexpr const char* kReader = "found a reader of palpate/tool/measured_cp that does not fit: ";
constexpr const char* kWriter = "found a writer of palpate/tool/measured_cp that does not fit: ";

TEST_F(EndpointWatchTest, SaysNothingOfATapOnOthersInItsOwnProcess) {
  const Tap<ToolPose> tap(
      participant_, [](const ToolPose&, WriterId, void*) noexcept {}, nullptr, Hears::kOthers);
  for (int i = 0; i < 5; ++i) {
    std::this_thread::sleep_for(30ms);
    EXPECT_EQ(watch_.poll(), std::vector<std::string>{});
  }
}

TEST_F(EndpointWatchTest, SaysNothingOfThoseThatMatch) {
  joinWriter([](dds_qos_t*) {});
  ASSERT_TRUE(reader_.waitForWriters(2, 5s));
  std::this_thread::sleep_for(30ms);
  EXPECT_TRUE(watch_.poll().empty());
  std::this_thread::sleep_for(30ms);
  EXPECT_TRUE(watch_.poll().empty());
}

TEST_F(EndpointWatchTest, SaysNothingOfItsOwnParticipantsReaderThatHearsOthersOnly) {
  const Tap<ToolPose> deaf(
      participant_, [](const ToolPose&, WriterId, void*) noexcept {}, nullptr, Hears::kOthers);
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(watch_.poll().empty());
    std::this_thread::sleep_for(20ms);
  }
}

TEST_F(EndpointWatchTest, NamesEveryPolicyOfAReaderThatAsksForMore) {
  joinReader([](dds_qos_t* qos) {
    dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_deadline(qos, DDS_MSECS(5));
    dds_qset_liveliness(qos, DDS_LIVELINESS_AUTOMATIC, DDS_MSECS(50));
    dds_qset_ownership(qos, DDS_OWNERSHIP_EXCLUSIVE);
    dds_qset_destination_order(qos, DDS_DESTINATIONORDER_BY_SOURCE_TIMESTAMP);
    dds_qset_presentation(qos, DDS_PRESENTATION_TOPIC, false, true);
  });
  EXPECT_EQ(told(), std::string(kReader) +
                        "durability, deadline, liveliness, destination order, ownership, presentation");
}

TEST_F(EndpointWatchTest, NamesAPartitionWhichDdsDoesNotReportAtAll) {
  joinWriter([](dds_qos_t* qos) { dds_qset_partition1(qos, "left hand"); });
  EXPECT_EQ(told(), std::string(kWriter) + "partition");
}

TEST_F(EndpointWatchTest, NamesATypeOfAnotherName) {
  joinWriter([](dds_qos_t*) {}, final_ToolPose_desc);
  EXPECT_EQ(told(), std::string(kWriter) + "type (final::ToolPose instead of palpate::ToolPose)");
}

TEST_F(EndpointWatchTest, TellsATypeOfTheSameNameWithOtherFields) {
  static dds_topic_descriptor_t other = palpate_ToolForce_desc;
  other.m_typename = palpate_ToolPose_desc.m_typename;
  joinWriter([](dds_qos_t*) {}, other);
  EXPECT_EQ(told(), std::string(kWriter) + "type (another version of palpate.idl?)");
}

TEST_F(EndpointWatchTest, TellsOfEachEndpointOnce) {
  joinWriter([](dds_qos_t* qos) { dds_qset_partition1(qos, "left hand"); });
  EXPECT_NE(told(), "");
  std::this_thread::sleep_for(30ms);
  EXPECT_TRUE(watch_.poll().empty());
}

TEST_F(EndpointWatchTest, AnEndpointKnowsItsOwnMismatchAndForgetsItOnceTheOtherLeft) {
  {
    const Participant other(palpate::testing::exclusiveDomain());
    const Topic<ToolPose> topic(other);
    const QosPtr qos(dds_create_qos());
    dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
    const Entity demanding(dds_create_reader(other.handle(), topic.handle(), qos.get(), nullptr));
    ASSERT_TRUE(eventually([&] {
      return writer_.mismatch().starts_with(std::string(kReader) + "durability; it is ");
    })) << writer_.mismatch();
  }
  EXPECT_TRUE(eventually([&] { return writer_.mismatch().empty(); })) << writer_.mismatch();
}

}  // namespace
}  // namespace palpate::dds
