// SPDX-License-Identifier: Apache-2.0
#include "field_log.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <thread>

#include "palpate/idl/writer.h"
#include "palpate/testing/test_domain.h"
#include "small_surface.h"

namespace palpate::watch {
namespace {

using namespace std::chrono_literals;

// A writer and a log on one participant: data arrives on the writer's own thread.
struct Wire {
  palpate::testing::SmallSurface source;
  client::Surface surface{client::checkedSurface(source.message())};
  dds::Participant participant{palpate::testing::exclusiveDomain()};
  FieldLog log{std::make_shared<const client::Surface>(surface)};
  dds::Reader<dds::SurfaceDisplacement> reader{
      participant,
      [](dds::ReaderView<dds::SurfaceDisplacement> view, void* context) noexcept {
        static_cast<FieldLog*>(context)->take(view);
      },
      &log};
  dds::Writer<dds::SurfaceDisplacement> writer{participant};
  std::vector<float> u = std::vector<float>(15, 0.0F);

  void send(std::uint64_t seq, const std::string& model_id, std::uint64_t session = 1) {
    dds::SurfaceDisplacement field{};
    field.session = session;
    dds::assignText(field.model_id, model_id);
    field.seq = seq;
    const auto size = static_cast<std::uint32_t>(u.size());
    field.displacement = {size, size, u.data(), false};
    EXPECT_TRUE(writer.write(field));
  }
};

TEST(FieldLog, KeepsTheLargestDisplacementAndWhereItWas) {
  Wire wire;
  ASSERT_TRUE(wire.writer.waitForReaders(1, 5s));
  wire.u[3 * 2 + 1] = -0.004F;
  wire.send(1, wire.source.model_id);
  wire.u[3 * 2 + 1] = 0.001F;
  wire.send(4, wire.source.model_id);
  const FieldSummary summary = wire.log.summary();
  EXPECT_EQ(summary.received, 2U);
  EXPECT_EQ(summary.superseded, 2U);
  EXPECT_EQ(summary.peak.node, 2U);
  EXPECT_FLOAT_EQ(static_cast<float>(summary.peak.size), 0.004F);
  EXPECT_FLOAT_EQ(static_cast<float>(summary.largest.size), 0.001F);
  EXPECT_FLOAT_EQ(wire.log.peakField()[7], -0.004F);
}

TEST(FieldLog, FollowsOneServerWhenTwoDisplaceTheSameOrgan) {
  Wire wire;
  ASSERT_TRUE(wire.writer.waitForReaders(1, 5s));
  for (std::uint64_t i = 1; i <= 5; ++i) {
    wire.send(i, wire.source.model_id, 1);
    wire.send(1000 * i, wire.source.model_id, 2);
  }
  const FieldSummary summary = wire.log.summary();
  EXPECT_EQ(summary.received, 5U);
  EXPECT_EQ(summary.superseded, 0U);
  EXPECT_EQ(summary.left_out, 5U);
  EXPECT_TRUE(wire.log.holds(1));
  EXPECT_FALSE(wire.log.holds(2)) << "it takes none of the rate either";
}

TEST(FieldLog, RefusesFieldsThatDoNotBelongToTheSurface) {
  Wire wire;
  ASSERT_TRUE(wire.writer.waitForReaders(1, 5s));
  wire.send(1, "another model");
  wire.u.resize(12);
  wire.send(2, wire.source.model_id);
  wire.u.assign(15, std::nanf(""));
  wire.send(3, wire.source.model_id);
  EXPECT_EQ(wire.log.summary().refused, 3U);
  EXPECT_EQ(wire.log.summary().received, 0U);
}

TEST(FieldLog, GoesOnWithTheSurfaceOfAnotherModel) {
  Wire wire;
  ASSERT_TRUE(wire.writer.waitForReaders(1, 5s));
  wire.u[3 * 2 + 1] = -0.004F;
  wire.send(1, wire.source.model_id);
  wire.send(2, "next");
  EXPECT_EQ(wire.log.summary().refused, 1U) << "its surface has not come yet";
  auto next = std::make_shared<client::Surface>(wire.surface);
  next->model_id = "next";
  wire.log.change(next);
  EXPECT_EQ(wire.log.summary().peak.size, 0.0) << "that was another organ";
  wire.u[3 * 2 + 1] = -0.001F;
  wire.send(3, "next");
  wire.send(4, wire.source.model_id);
  const FieldSummary summary = wire.log.summary();
  EXPECT_EQ(summary.refused, 2U);
  EXPECT_EQ(summary.model_changes, 1U);
  EXPECT_FLOAT_EQ(static_cast<float>(summary.peak.size), 0.001F);
  EXPECT_EQ(summary.surface->model_id, "next");
}

}  // namespace
}  // namespace palpate::watch
