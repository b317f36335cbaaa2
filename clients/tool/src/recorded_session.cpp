// SPDX-License-Identifier: Apache-2.0
#include "recorded_session.h"

#include <algorithm>
#include <limits>

#include "core/record/record_reader.h"
#include "palpate/client/letting_go.h"

namespace palpate::tool {
namespace {

using record::PoseFacts;
using record::RecordError;

constexpr std::int64_t kMostClock = std::int64_t{1} << 61;  // ns, 73 years: differences stay within 64 bits
constexpr std::int64_t kStampSlack = 100'000'000;      // ns between a stamp and its arrival, from the least
constexpr std::int64_t kLongest = 86'400'000'000'000;  // ns, a day

/// A pose with both of its times.
struct Timed {
  RecordedPose pose;
  PoseFacts facts;
};

/// One tool's poses, as ticks tell of them.
class ToolReader {
 public:
  void add(const record::RecordedTick& tick, std::uint32_t tool) {
    const PoseFacts& facts = tick.poses[tool];
    const ToolResult& result = tick.result.tools[tool];
    const bool letting_go = letting_go_.add(result.flags);
    if (facts == last_) return;
    if (facts.arrival_ns < last_.arrival_ns || facts.arrival_ns > kMostClock)
      throw RecordError("tick " + std::to_string(tick.index) + ": tool " + std::to_string(tool) +
                        ": a pose arrived at " + std::to_string(facts.arrival_ns) +
                        " ns, the one before at " + std::to_string(last_.arrival_ns));
    last_ = facts;
    Timed timed;
    timed.facts = facts;
    timed.pose.tool = tool;
    std::copy_n(tick.input.tools[tool].position.begin(), 3, timed.pose.position.begin());
    timed.pose.orientation = tick.input.tools[tool].orientation;
    timed.pose.buttons = facts.buttons;
    std::copy_n(result.force.begin(), 3, timed.pose.force.begin());
    std::copy_n(result.anchor.begin(), 3, timed.pose.anchor.begin());
    timed.pose.flags = result.flags;
    timed.pose.state = result.state;
    timed.pose.letting_go = letting_go;
    timed.pose.late = tick.input.dt_ns / 3 > tick.input.period_ns / 2;
    poses_.push_back(timed);
  }

  /// Sets each pose's time on the server's clock. @return whether by stamps
  bool setTimes() {
    const std::optional<std::int64_t> least = leastWay();
    for (Timed& timed : poses_)
      timed.pose.t_ns = least ? timed.facts.stamp_ns + *least : timed.facts.arrival_ns;
    return least.has_value();
  }
  [[nodiscard]] const std::vector<Timed>& poses() const noexcept { return poses_; }

 private:
  // Shortest time from a stamp to its arrival, with the two clocks' difference. Nothing where stamps are no timing.
  [[nodiscard]] std::optional<std::int64_t> leastWay() const {
    std::int64_t least = std::numeric_limits<std::int64_t>::max(),
                 most = std::numeric_limits<std::int64_t>::min();
    std::int64_t before = -kMostClock;
    for (const auto& [pose, facts] : poses_) {
      if (facts.stamp_ns == 0 || facts.stamp_ns < before || facts.stamp_ns > kMostClock) return std::nullopt;
      before = facts.stamp_ns;
      least = std::min(least, facts.arrival_ns - facts.stamp_ns);
      most = std::max(most, facts.arrival_ns - facts.stamp_ns);
    }
    if (most - least > kStampSlack) return std::nullopt;
    return least;
  }

  std::vector<Timed> poses_;
  PoseFacts last_;
  client::LettingGo letting_go_;
};

// Reads to the end, or to where the file ends early if that is allowed.
void readTicks(record::RecordReader& reader, const Wanted& wanted, std::array<ToolReader, kTools>& tools,
               RecordedSession& session) {
  record::RecordedTick tick;
  try {
    while (reader.next(tick)) {
      session.changes += tick.input.has_settings != 0 ? 1 : 0;
      for (std::uint32_t tool = 0; tool < kTools; ++tool)
        if (!wanted.tool || *wanted.tool == tool) tools[tool].add(tick, tool);
    }
    session.missing = reader.end().missing;
  } catch (const record::TruncatedError& error) {
    if (!wanted.partial) throw RecordError(std::string(error.what()) + " (--partial plays what is there)");
    session.truncated = true;
  }
}

void gather(std::array<ToolReader, kTools>& tools, RecordedSession& session) {
  for (std::size_t tool = 0; tool < kTools; ++tool) {
    session.by_stamp[tool] = tools[tool].setTimes();
    for (const Timed& timed : tools[tool].poses()) session.poses.push_back(timed.pose);
  }
  std::stable_sort(session.poses.begin(), session.poses.end(),
                   [](const RecordedPose& a, const RecordedPose& b) { return a.t_ns < b.t_ns; });
}

}  // namespace

RecordedSession readSession(const std::filesystem::path& file, const Wanted& wanted) {
  const auto refuse = [&](const std::string& text) { throw RecordError(file.string() + ": " + text); };
  // 1. All ticks.
  record::RecordReader reader(file);
  RecordedSession session;
  session.model_id = reader.facts().model.id();
  session.engine = reader.facts().engine.text();
  for (std::size_t tool = 0; tool < kTools; ++tool)
    session.tip_radius[tool] = toolSettings(reader.facts().config)[tool].tip_radius;
  std::array<ToolReader, kTools> tools;
  readTicks(reader, wanted, tools, session);
  if (session.missing > 0 && !wanted.partial)
    refuse(std::to_string(session.missing) + " ticks are missing (--partial plays all the same)");
  // 2. The poses, by the time at which they were sent.
  gather(tools, session);
  if (session.poses.empty())
    refuse(wanted.tool ? "no pose of tool " + std::to_string(*wanted.tool)
                       : std::string("no pose of any tool"));
  const std::int64_t first_ns = session.poses.front().t_ns;
  for (RecordedPose& pose : session.poses) pose.t_ns -= first_ns;
  // 3. No longer than wanted.
  if (wanted.seconds) {
    const auto end_ns = static_cast<std::int64_t>(1e9 * *wanted.seconds);
    std::erase_if(session.poses, [&](const RecordedPose& pose) { return pose.t_ns > end_ns; });
  }
  session.has = {};
  for (const RecordedPose& pose : session.poses) session.has[pose.tool] = true;
  if (session.poses.back().t_ns > kLongest)
    refuse("its poses span " + std::to_string(session.poses.back().t_ns / 1'000'000'000) +
           " s, more than a day (--seconds plays a part)");
  return session;
}

}  // namespace palpate::tool
