// SPDX-License-Identifier: Apache-2.0
#include <grown.h>  // palpate.idl with a field more at the end of ToolPose and ToolForce

#include "link.h"

namespace palpate::dds {
namespace {

// A program that was built with the later types.
template <class Grown>
class LaterProgram {
 public:
  LaterProgram(const dds_topic_descriptor_t& descriptor, const char* type, const char* topic)
      : descriptor_(descriptor) {
    descriptor_.m_typename = const_cast<char*>(type);
    topic_ = Entity(dds_create_topic(participant_.handle(), &descriptor_, topic, nullptr, nullptr));
    writer_ = Entity(dds_create_writer(participant_.handle(), topic_.handle(), nullptr, nullptr));
    reader_ = Entity(dds_create_reader(participant_.handle(), topic_.handle(), nullptr, nullptr));
  }
  void write(const Grown& sample) { EXPECT_EQ(dds_write(writer_.handle(), &sample), DDS_RETCODE_OK); }
  [[nodiscard]] bool take(Grown& sample) {
    void* buffer = &sample;
    dds_sample_info_t info{};
    return dds_take(reader_.handle(), &buffer, &info, 1, 1) == 1 && info.valid_data;
  }

 private:
  Participant participant_{palpate::testing::exclusiveDomain()};
  dds_topic_descriptor_t descriptor_;
  Entity topic_, writer_, reader_;
};

TEST(Growth, APoseOfALaterProgramIsReadWithoutItsNewField) {
  const Participant participant(palpate::testing::exclusiveDomain());
  const Reader<ToolPose> reader(participant);
  LaterProgram<grown_ToolPose> later(grown_ToolPose_desc, palpate_ToolPose_desc.m_typename,
                                     TopicTraits<ToolPose>::kName);
  ASSERT_TRUE(reader.waitForWriters(1, 5s)) << reader.mismatch();
  grown_ToolPose sent{};
  sent.tool_id = 2;
  sent.seq = 41;
  sent.orientation[3] = 1.0;
  sent.buttons = 5;
  sent.added = 7.5;
  later.write(sent);
  ToolPose got{};
  ASSERT_TRUE(eventually([&] { return reader.take({&got, 1}) == 1; }));
  EXPECT_EQ(got.tool_id, 2U);
  EXPECT_EQ(got.seq, 41U);
  EXPECT_EQ(got.orientation[3], 1.0);
  EXPECT_EQ(got.buttons, 5U);
}

TEST(Growth, ALaterProgramReadsAForceOfTodayAndItsNewFieldIsZero) {
  const Participant participant(palpate::testing::exclusiveDomain());
  Writer<ToolForce> writer(participant);
  LaterProgram<grown_ToolForce> later(grown_ToolForce_desc, palpate_ToolForce_desc.m_typename,
                                      TopicTraits<ToolForce>::kName);
  ASSERT_TRUE(writer.waitForReaders(1, 5s)) << writer.mismatch();
  ToolForce sent{};
  sent.tool_id = 3;
  sent.seq = 42;
  sent.stiffness[8] = -0.5;
  sent.pose_wait_ns = -9;
  ASSERT_TRUE(writer.write(sent));
  grown_ToolForce got{};
  got.added = 7.5;
  ASSERT_TRUE(eventually([&] { return later.take(got); }));
  EXPECT_EQ(got.tool_id, 3U);
  EXPECT_EQ(got.seq, 42U);
  EXPECT_EQ(got.stiffness[8], -0.5);
  EXPECT_EQ(got.pose_wait_ns, -9);
  EXPECT_EQ(got.added, 0.0);
}

}  // namespace
}  // namespace palpate::dds
