// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/record/recording.h"

namespace palpate::replay {

/// One tool in one tick of a recording: a row of the table.
struct TableRow {
  const record::RecordedTick& tick;
  std::size_t tool;
  std::int64_t start_ns;  ///< woke_ns of the recording's first tick
  bool new_pose;          ///< this tick is the first that knew the pose

  [[nodiscard]] const ToolInput& input() const noexcept { return tick.input.tools[tool]; }
  [[nodiscard]] const ToolResult& result() const noexcept { return tick.result.tools[tool]; }
  [[nodiscard]] const record::PoseFacts& facts() const noexcept { return tick.poses[tool]; }
};

/// a - b in s, of times that may be any.
[[nodiscard]] inline double secondsBetween(std::int64_t b, std::int64_t a) noexcept {
  return 1e-9 * static_cast<double>(
                    static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b)));
}

/// The columns in their order, each once. docs/recording_file.md, The table, lists them too.
/// visit(name, unit, what, value): value is a std::uint64_t, std::int64_t or double
template <class Visit>
void forEachColumn(const TableRow& row, Visit&& visit) {
  const auto whole = [](auto number) { return static_cast<std::uint64_t>(number); };
  const auto vector = [&](const char* const(&names)[3], const char* unit, const char* what,
                          const std::array<double, 3>& values) {
    for (std::size_t k = 0; k < 3; ++k) visit(names[k], unit, what, values[k]);
  };
  visit("tick", "1", "ticks that the server ran before this one", row.tick.index);
  visit("time_s", "s", "when the tick woke, since the first tick",
        secondsBetween(row.start_ns, row.tick.woke_ns));
  visit("tool", "1", "tool id", whole(row.tool));
  visit("new_pose", "1", "1: the first tick that knew this pose; 0: a pose used again", whole(row.new_pose));
  visit("pose_seq", "1", "the sender's number of the pose", row.facts().seq);
  visit("pose_stamp_ns", "ns", "the pose's stamp by the sender's clock; 0: not valid", row.facts().stamp_ns);
  visit("pose_arrival_s", "s", "when the pose came in, since the first tick",
        secondsBetween(row.start_ns, row.facts().arrival_ns));
  visit("buttons", "1", "bit i: button i is held down", whole(row.facts().buttons));
  vector({"position_x_m", "position_y_m", "position_z_m"}, "m", "p_WT, tip centre in world frame W",
         row.input().position);
  constexpr const char* kOrientation[]{"orientation_x", "orientation_y", "orientation_z", "orientation_w"};
  for (std::size_t k = 0; k < 4; ++k)
    visit(kOrientation[k], "1", "q_WT, unit quaternion", row.input().orientation[k]);
  vector({"force_x_N", "force_y_N", "force_z_N"}, "N", "force of the organ on the tool in W",
         row.result().force);
  visit("state", "1", "0 free, 1 stick, 2 slide", whole(row.result().state));
  visit("flags", "1", "FLAG_* of palpate.idl", whole(row.result().flags));
  visit("penetration_m", "m", "-d . n with the outward normal n, as the pose asks", row.result().penetration);
  vector({"anchor_x_m", "anchor_y_m", "anchor_z_m"}, "m",
         "X(s), rest position of the material point that the tool holds", row.result().anchor);
  vector({"proxy_x_m", "proxy_y_m", "proxy_z_m"}, "m", "X(s) + u(X(s)), where the anchor is now",
         row.result().proxy);
}

}  // namespace palpate::replay
