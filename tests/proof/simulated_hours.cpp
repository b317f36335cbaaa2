// SPDX-License-Identifier: Apache-2.0
#include "simulated_hours.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <new>
#include <stdexcept>

#include "core/base/status_flags.h"
#include "palpate/server/config.h"
#include "palpate/server/facts.h"
#include "palpate/server/pose_subscriber.h"
#include "palpate/server/tick.h"
#include "palpate/testing/allocation_guard.h"

namespace palpate::proof {
namespace {

using server::ForceRecord;

constexpr std::int64_t kPeriod = 1'000'000;       // ns
constexpr std::int64_t kLate = 7;                 // ns that each tick wakes late
constexpr std::uint64_t kContactTicks = 1800;     // from touching down to lifting off, of a tool
constexpr std::uint64_t kStagger = 1200;          // from one tool's touching down to the next one's
constexpr double kAbove = 0.003, kDepth = 0.002;  // m
constexpr double kSlide = 0.002;                  // m
constexpr std::uint32_t kExpectedFlags =
    kInContact | kRamping | kAnswerCutShort | kForceLimited | kBeyondDomain;
constexpr double kPi = 3.14159265358979323846;

struct Place {
  Vec3 position, normal, along;
};

/// Accessible positions, the first and then always the one that is farthest from those before.
std::array<Place, kMaxTools> placesOn(const MetaModel& model) {
  const ModelView& view = model.view();
  std::vector<Place> all;
  for (std::size_t i = 0; i < view.contact_accessible.size(); ++i) {
    if (view.contact_accessible[i] == 0) continue;
    const int node = view.contact_node[i];
    const Vec3 normal = model.surface().nodeNormal(node);
    const Vec3 across = std::abs(normal.x()) < 0.5 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    all.push_back(
        {model.surface().position(model.surface().atNode(node)), normal, normal.cross(across).normalized()});
  }
  if (all.size() < kMaxTools) throw std::invalid_argument("the organ has fewer than four accessible places");
  std::array<Place, kMaxTools> chosen{};
  std::size_t count = 0;
  const auto distance = [&](const Place& place) {
    double least = 1e300;
    for (std::size_t k = 0; k < count; ++k)
      least = std::min(least, (place.position - chosen[k].position).norm());
    return least;
  };
  for (; count < chosen.size(); ++count)
    chosen[count] = *std::max_element(
        all.begin(), all.end(), [&](const Place& a, const Place& b) { return distance(a) < distance(b); });
  return chosen;
}

/// Where a tool's tip is at a tick of a session, m. It ends where it began.
Vec3 tipAt(const Place& place, double radius, std::size_t tool, std::uint64_t tick) {
  const std::uint64_t begin = 400 + kStagger * tool;
  const bool down = tick >= begin && tick < begin + kContactTicks;
  const double part = down ? static_cast<double>(tick - begin) / kContactTicks : 0.0;
  const double sway = std::sin(2.0 * kPi * static_cast<double>(tick) /
                               kSessionTicks);  // it moves where it does not press, too
  const double height = kAbove - (kAbove + kDepth) * std::pow(std::sin(kPi * part), 2.0);
  return place.position + (radius + height) * place.normal +
         (0.5 * sway + std::sin(2.0 * kPi * part)) * kSlide * place.along;
}

double residentMiB() {
  std::ifstream file("/proc/self/statm");
  double all = 0.0, resident = 0.0;
  file >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

bool sameBits(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::bit_cast<std::array<std::uint64_t, 3>>(a) == std::bit_cast<std::array<std::uint64_t, 3>>(b);
}

class Simulation {
 public:
  Simulation(const std::shared_ptr<const MetaModel>& model, const SimulatedOptions& options)
      : options_(options),
        config_(server::factsOf(*model, server::ServerConfig{}).step),
        engine_(model, config_),
        first_tick_((1ULL << 32U) - kSessionTicks * options.sessions / 2),
        first_ns_((1LL << 53U) - kPeriod * static_cast<std::int64_t>(kSessionTicks * options.sessions / 2)) {
    channels_->field_readers = 1;
    const auto places = placesOn(*model);
    for (std::size_t tool = 0; tool < kMaxTools; ++tool)
      for (std::uint64_t tick = 0; tick < kSessionTicks; ++tick)
        tips_[tool].push_back(tipAt(places[tool], config_.tip_radius, tool, tick));
    for (auto& tool : forces_) tool.resize(kSessionTicks);
  }

  void runSession(std::uint64_t session, SimulatedRow& row) {
    const testing::AllocationGuard guard;
    for (std::uint64_t tick = 0; tick < kSessionTicks; ++tick) {
      const std::uint64_t index = session * kSessionTicks + tick;
      const std::int64_t now_ns = first_ns_ + kPeriod * static_cast<std::int64_t>(index);
      changeParameters(tick);
      send(session, tick, now_ns);
      (void)tick_.run({first_tick_ + index, now_ns, now_ns + kLate, 50'000, 0});
      if (options_.leaking_session != 0 && session >= options_.leaking_session) leaked_ = ::operator new(16);
      readForces(session, tick, now_ns, row);
      readTick(index, row);
      readField(row);
    }
    row.ticks += kSessionTicks;
    row.allocations += guard.count();
  }

 private:
  // At ticks in which all tools are free, and long enough before the session's end.
  void changeParameters(std::uint64_t tick) {
    if (tick != 10 && tick != kSessionTicks - 1000) return;
    AllToolSettings settings = toolSettings(config_);
    if (tick == 10)
      for (ToolSettings& tool : settings) tool.live.friction = 0.5 * config_.friction;
    (void)channels_->parameters.write(settings);
  }

  void send(std::uint64_t session, std::uint64_t tick, std::int64_t now_ns) {
    for (std::size_t tool = 0; tool < kMaxTools; ++tool) {
      dds::ToolPose pose{};
      pose.tool_id = static_cast<std::uint32_t>(tool);
      pose.seq = poseSeq(session, tick);
      pose.stamp_ns = now_ns - 1000;
      for (int k = 0; k < 3; ++k) pose.position[k] = tips_[tool][tick][k];
      if (session == options_.nudged_session && session != 0 && tool == 0) pose.position[2] += 1e-12;
      pose.orientation[3] = 1.0;
      intake_.accept(pose, 1 + tool, now_ns - 500);
    }
  }

  [[nodiscard]] std::uint64_t poseSeq(std::uint64_t session, std::uint64_t tick) const {
    return first_tick_ + session * kSessionTicks + tick;
  }

  void readForces(std::uint64_t session, std::uint64_t tick, std::int64_t now_ns, SimulatedRow& row) {
    ForceRecord record;
    std::uint64_t answers = 0;
    for (; channels_->forces.pop(record); ++answers) {
      const ToolResult& result = record.result;
      const double size = std::hypot(result.force[0], result.force[1], result.force[2]);
      row.largest_force = std::max(row.largest_force, size);
      row.in_contact += (result.flags & kInContact) != 0 ? 1 : 0;
      row.not_finite += std::isfinite(size) ? 0 : 1;
      row.beyond_limit += size > config_.force_limit * (1.0 + 1e-12) ? 1 : 0;
      row.faults += (result.flags & ~kExpectedFlags) != 0 ? 1 : 0;
      row.cut_short += (result.flags & kAnswerCutShort) != 0 ? 1 : 0;
      row.lost += record.superseded;
      const bool next = record.seq == session * kSessionTicks + tick + 1 &&
                        record.pose_seq == poseSeq(session, tick) && record.pose_stamp_ns == now_ns - 1000 &&
                        record.stamp_ns == now_ns + kLate && record.wakeup_ns == kLate &&
                        record.pose_wait_ns == kLate + 500;
      row.out_of_step += next ? 0 : 1;
      compare(session, tick, record, row);
    }
    row.lost += kMaxTools - answers;
  }

  // The first session begins with tools that nobody has seen: their forces are ramped.
  void compare(std::uint64_t session, std::uint64_t tick, const ForceRecord& record, SimulatedRow& row) {
    if (session == 0) return;
    std::array<double, 3>& before = forces_[record.tool_id][tick];
    if (session == 1) before = record.result.force;
    if (sameBits(before, record.result.force)) return;
    ++row.differing;
    for (std::size_t k = 0; k < 3; ++k)
      row.largest_difference = std::max(row.largest_difference, std::abs(before[k] - record.result.force[k]));
  }

  void readTick(std::uint64_t index, SimulatedRow& row) {
    server::TickRecord record;
    while (channels_->ticks.pop(record)) {
      row.out_of_step += record.ticks == first_tick_ + index + 1 ? 0 : 1;
      row.lost += record.rejected + record.unordered + record.dropped;
    }
  }

  void readField(SimulatedRow& row) {
    if (!channels_->surface.update() || !engine_.shown.show(channels_->surface.front().state)) return;
    const auto field = engine_.shown.displacement();
    const bool finite = std::all_of(field.begin(), field.end(), [](float u) { return std::isfinite(u); });
    row.not_finite += finite && !engine_.shown.overflowed() ? 0 : 1;
  }

  SimulatedOptions options_;
  StepConfig config_;
  server::Engine engine_;
  std::unique_ptr<server::Channels> channels_ = std::make_unique<server::Channels>();
  server::PoseIntake intake_{*channels_, config_};
  server::Tick tick_{engine_, *channels_, {kPeriod, 250 * kPeriod}};
  void* volatile leaked_{nullptr};  // a new expression that nobody reads would be left out by the compiler
  std::uint64_t first_tick_;
  std::int64_t first_ns_;
  std::array<std::vector<Vec3>, kMaxTools> tips_;
  std::array<std::vector<std::array<double, 3>>, kMaxTools> forces_;  // of the second session
};

}  // namespace

std::vector<SimulatedRow> simulateHours(const std::shared_ptr<const MetaModel>& model,
                                        const SimulatedOptions& options,
                                        const std::function<void(const SimulatedRow&)>& told) {
  const auto simulation = std::make_unique<Simulation>(model, options);
  std::vector<SimulatedRow> rows;
  auto began = std::chrono::steady_clock::now();
  for (std::uint64_t session = 0; session < options.sessions; ++session) {
    if (session % options.sessions_a_row == 0) rows.emplace_back();
    simulation->runSession(session, rows.back());
    if ((session + 1) % options.sessions_a_row != 0 && session + 1 != options.sessions) continue;
    const auto now = std::chrono::steady_clock::now();
    rows.back().seconds = std::chrono::duration<double>(now - began).count();
    rows.back().resident_MiB = residentMiB();
    began = now;
    if (told) told(rows.back());
  }
  return rows;
}

}  // namespace palpate::proof
