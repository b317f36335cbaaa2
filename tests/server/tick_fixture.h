// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "palpate/server/pose_subscriber.h"
#include "palpate/server/tick.h"
#include "palpate/testing/synthetic_model.h"

namespace palpate::server::testing {

inline constexpr std::int64_t kPeriod = 1'000'000;
inline constexpr dds::WriterId kSender = 1;
inline constexpr dds::WriterId kOther = 2;

/// One model for all tests of a process: under a sanitizer, making it takes longer than what a test does with it.
inline const MetaModel& syntheticModel() {
  static const MetaModel model = [] {
    const palpate::testing::TemporaryFile file("tick.h5");
    palpate::testing::writeSyntheticModel(file.path());
    return MetaModel::load(file.path());
  }();
  return model;
}

/// A tick on the synthetic model, and the time that the test keeps.
class TickTest : public ::testing::Test {
 protected:
  // An accessible node and the normal there; somebody reads fields.
  TickTest() {
    channels_->field_readers = 1;
    const ModelView& view = model_.view();
    std::size_t position = 0;
    while (view.contact_accessible[position] == 0) ++position;
    const int node = view.contact_node[position];
    const ContactPoint s = model_.surface().atNode(node);
    place_ = model_.surface().position(s);
    normal_ = model_.surface().nodeNormal(node);
  }

  [[nodiscard]] dds::ToolPose poseAtDepth(std::uint32_t tool, double depth) {
    dds::ToolPose pose{};
    pose.tool_id = tool;
    pose.seq = ++pose_seq_;
    pose.stamp_ns = now_ns_;
    const Vec3 centre = place_ + (StepConfig{}.tip_radius - depth) * normal_;
    for (int k = 0; k < 3; ++k) pose.position[k] = centre[k];
    pose.orientation[3] = 1.0;
    return pose;
  }

  void send(const dds::ToolPose& pose) noexcept { intake_.accept(pose, kSender, now_ns_); }

  void runOneTick() noexcept {
    now_ns_ += kPeriod;
    cycle_.deadline_ns = now_ns_;
    cycle_.woke_ns = now_ns_ + 7;
    shift_ns_ = tick_.run(cycle_);
    ++cycle_.index;
    cycle_.previous_ns = 50'000;
  }

  // All forces that lie in the ring.
  std::vector<ForceRecord> takeForces() {
    std::vector<ForceRecord> records;
    ForceRecord record;
    while (channels_->forces.pop(record)) records.push_back(record);
    return records;
  }

  // The flags of all forces that lie in the ring. Allocates nothing.
  std::uint32_t takeFlags() noexcept {
    std::uint32_t flags = 0;
    ForceRecord record;
    while (channels_->forces.pop(record)) flags |= record.result.flags;
    return flags;
  }

  TickRecord takeLastRecord() {
    TickRecord record;
    while (channels_->ticks.pop(record)) {
    }
    return record;
  }

  const MetaModel& model_ = syntheticModel();
  Engine engine_{{std::shared_ptr<const void>{}, &model_}, StepConfig{}};
  Workspace& work_ = engine_.work;
  std::unique_ptr<Channels> channels_ = std::make_unique<Channels>();
  PoseIntake intake_{*channels_, StepConfig{}};
  Tick tick_{engine_, *channels_, {kPeriod}};
  rt::Cycle cycle_;
  std::int64_t now_ns_{1'000'000'000};
  std::int64_t shift_ns_{0};
  std::uint64_t pose_seq_{0};
  Vec3 place_;
  Vec3 normal_;
};

}  // namespace palpate::server::testing
