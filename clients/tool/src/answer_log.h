// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "palpate/client/gap_counter.h"
#include "palpate/client/letting_go.h"
#include "palpate/idl/types.h"

namespace palpate::tool {

/// The first answer to each pose of one tool. The receive thread writes it; it is read after the ToolClient, and so the
/// receiving, has ended. Real-time: yes, once it is made.
struct AnswerLog {
  struct Answer {
    dds::ToolForce force;
    bool letting_go;  ///< the server fades the force, because poses had stopped
  };

  explicit AnswerLog(std::size_t capacity) { first_answers.reserve(capacity); }

  static void onForce(const dds::ToolForce& force, std::int64_t, void* context) noexcept {
    auto& self = *static_cast<AnswerLog*>(context);
    self.answers.add(force.session, force.seq);
    const bool letting_go = self.letting_go.add(force.flags);
    if ((force.flags & dds::flag::kShuttingDown) != 0)
      self.server_left.store(true, std::memory_order_relaxed);
    const bool first = force.pose_seq > self.newest_pose;
    if (!first || self.first_answers.size() == self.first_answers.capacity()) return;
    self.newest_pose = force.pose_seq;
    self.first_answers.push_back({force, letting_go});
  }

  std::vector<Answer> first_answers;
  client::GapCounter answers;
  client::LettingGo letting_go;
  std::uint64_t newest_pose{0};
  std::atomic<bool> server_left{false};  // orders nothing else while receiving
};

}  // namespace palpate::tool
