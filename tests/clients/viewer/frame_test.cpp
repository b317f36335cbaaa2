// SPDX-License-Identifier: Apache-2.0
// The binary messages, byte by byte as PROTOCOL.md has them.
#include "frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../small_surface.h"
#include "read_bytes.h"

namespace palpate::viewer {
namespace {

using testing::at;

TEST(ViewerFrame, FieldIsWithinHalfAStepOfWhatItWas) {
  std::vector<float> u;
  for (int i = 0; i < 300; ++i) u.push_back(0.012F * std::sin(0.37F * static_cast<float>(i * i)));
  const EncodedField field = encodeField(u);
  ASSERT_EQ(field.values.size(), u.size());
  EXPECT_LE(field.scale, 0.012F / 32766.0F);
  for (std::size_t i = 0; i < u.size(); ++i)
    EXPECT_NEAR(field.scale * static_cast<float>(field.values[i]), u[i], 0.51F * field.scale);
}

TEST(ViewerFrame, AFieldOfZerosStaysZeroAndHasAScale) {
  const EncodedField field = encodeField(std::vector<float>(6, 0.0F));
  EXPECT_GT(field.scale, 0.0F);
  ASSERT_EQ(field.values.size(), 6U);
  for (const std::int16_t unit : field.values) EXPECT_EQ(unit, 0);
}

TEST(ViewerFrame, HoldsFieldToolsAndAnswersAtTheirPlaces) {
  EncodedField field = encodeField(std::vector<float>{0.0F, 0.0F, -0.001F});  // 6 bytes, 2 of padding
  field.seq = 0x1122334455667788;
  field.sample_us = 12.5;
  ToolRecord tool;
  tool.tool_id = 2;
  tool.mine = true;
  tool.tip = {1.0F, 2.0F, 3.0F};
  tool.force = {0.1F, 0.2F, 0.3F};
  tool.domain_radius = 0.008F;
  AnswerRecord answer;
  answer.tool_id = 2;
  answer.flags = 129;
  answer.t_us = 77.25;
  answer.stiffness = 450.0F;
  answer.force_vector = {1.0F, 2.0F, 3.0F};
  answer.tip = {0.1F, 0.2F, 0.3F};
  Frame frame;
  frame.seq = 9;
  frame.mesh_revision = 4;
  frame.field = &field;
  frame.sent_us = 99.5;
  frame.tools = {&tool, 1};
  frame.answers = {&answer, 1};
  Bytes out;
  encodeFrame(frame, out);
  ASSERT_EQ(out.size(), 56U + 8U + 72U + 56U);
  EXPECT_EQ(at<std::uint32_t>(out, 0), 2U);
  EXPECT_EQ(at<std::uint32_t>(out, 4), 9U);
  EXPECT_EQ(at<std::uint32_t>(out, 8), 4U);
  EXPECT_EQ(at<std::uint32_t>(out, 12), 1U);
  EXPECT_EQ(at<double>(out, 16), 12.5);
  EXPECT_EQ(at<double>(out, 24), 99.5);
  EXPECT_EQ(at<std::uint64_t>(out, 32), 0x1122334455667788U);
  EXPECT_EQ(at<std::uint32_t>(out, 40), 1U);
  EXPECT_EQ(at<std::uint32_t>(out, 44), 1U);
  EXPECT_NEAR(at<float>(out, 48) * static_cast<float>(at<std::int16_t>(out, 60)), -0.001F, 1e-7F);
  EXPECT_EQ(at<std::uint32_t>(out, 64), 2U) << "tool id";
  EXPECT_EQ(at<std::uint32_t>(out, 76), 1U) << "mine";
  EXPECT_EQ(at<float>(out, 88), 3.0F) << "tip z";
  EXPECT_EQ(at<float>(out, 116), 0.1F) << "force x";
  EXPECT_EQ(at<float>(out, 132), 0.008F) << "domain radius";
  EXPECT_EQ(at<std::uint32_t>(out, 140), 129U) << "answer's flags";
  EXPECT_EQ(at<double>(out, 144), 77.25);
  EXPECT_EQ(at<float>(out, 164), 450.0F);
  EXPECT_EQ(at<float>(out, 176), 3.0F) << "force z";
  EXPECT_EQ(at<float>(out, 188), 0.3F) << "tip z";
}

TEST(ViewerFrame, WithoutASurfaceIsHeaderToolsAndAnswersOnly) {
  Bytes out;
  encodeFrame(Frame{}, out);
  EXPECT_EQ(out.size(), kFrameHeaderSize);
  EXPECT_EQ(at<std::uint32_t>(out, 12), 0U);
  EXPECT_EQ(at<float>(out, 48), 0.0F);
}

TEST(ViewerFrame, OfTwoThousandNodesAndAllAnswersStaysBelowSixtyKilobytes) {
  const EncodedField field = encodeField(std::vector<float>(3 * 2009, 0.001F));
  const std::vector<ToolRecord> tools(4);
  const std::vector<AnswerRecord> answers(256);
  Bytes out;
  encodeFrame({1, 1, &field, 0.0, tools, answers}, out);
  EXPECT_LT(out.size(), 60'000U);
  EXPECT_GT(out.size(), 6U * 2009U);
}

TEST(ViewerFrame, MeshHasPositionsTrianglesAccessAndRegions) {
  testing::SmallSurface small;
  small.addRegions();
  const client::Surface surface = client::checkedSurface(small.message());
  Bytes out;
  encodeMesh(surface, 7, out);
  ASSERT_EQ(out.size(), 20U + 12U * 5U + 12U * 6U + 12U + 8U + 8U + 12U * 3U + 12U);
  EXPECT_EQ(at<std::uint32_t>(out, 0), 1U);
  EXPECT_EQ(at<std::uint32_t>(out, 4), 5U);
  EXPECT_EQ(at<std::uint32_t>(out, 8), 6U);
  EXPECT_EQ(at<std::uint32_t>(out, 12), 7U);
  EXPECT_EQ(at<std::uint32_t>(out, 16), 2U);
  EXPECT_EQ(at<float>(out, 20 + 12 * 4 + 8), 0.05F) << "the apex's z";
  EXPECT_EQ(at<std::uint32_t>(out, 80), 0U);
  EXPECT_EQ(at<std::uint32_t>(out, 84), 2U);
  EXPECT_EQ(at<std::uint8_t>(out, 152), 0U) << "node 0 is not accessible";
  EXPECT_EQ(at<std::uint8_t>(out, 156), 1U);
  EXPECT_EQ(at<std::uint8_t>(out, 157), 1U) << "node 0 is clamped";
  EXPECT_EQ(at<std::uint8_t>(out, 158), 0U);
  EXPECT_EQ(at<std::uint32_t>(out, 164), 0U) << "nodes of the first region, which has no surface";
  EXPECT_EQ(at<std::uint32_t>(out, 172), 3U);
  EXPECT_EQ(at<std::uint32_t>(out, 176), 1U);
  EXPECT_EQ(at<float>(out, 180 + 12 * 2 + 8), 0.02F) << "z of the last node of the second";
  EXPECT_EQ(at<std::uint32_t>(out, 180 + 12 * 3 + 8), 2U);
}

}  // namespace
}  // namespace palpate::viewer
