// SPDX-License-Identifier: Apache-2.0
#include "measure.h"

#include <chrono>
#include <cmath>
#include <optional>

#include "core/devices/path/path.h"
#include "palpate/client/error.h"
#include "palpate/client/sending.h"
#include "palpate/client/stop_signal.h"
#include "palpate/idl/reader.h"
#include "palpate/rt/clock.h"
#include "palpate/rt/pacer.h"

namespace palpate::latency {
namespace {

constexpr double kApproachSeconds = 1.0;
constexpr std::int64_t kGoneAfter = 1'000'000'000;  // ns without an answer

// Moves between 1 and 2 mm deep and 3 mm aside, one second per cycle, so that the force keeps changing and the tip slides.
device::Path gentlePress(const client::Spot& spot, const MeasureOptions& options) {
  const device::Point aside = 0.003 * device::tangentOf(spot.normal);
  const auto above = [&](double height) {
    return spot.position + (options.tip_radius + height) * spot.normal;
  };
  std::vector<device::Leg> legs{{above(-0.001), kApproachSeconds, "approach"}};
  for (double t = 0.0; t < options.seconds; t += 1.0) {
    legs.push_back({above(-0.002) + aside, 0.5, "in"});
    legs.push_back({above(-0.001), 0.5, "out"});
  }
  return device::Path(above(0.010), std::move(legs));
}

// Sends the path from time `from` to time `to`; the pacer's grid continues over the calls.
void send(client::ToolClient& tool, const device::Path& path, double from, double to, rt::Pacer& pacer,
          SenderStats& stats, SampleLog* samples = nullptr) {
  const std::int64_t start_ns = rt::monotonicNow();
  const double direction = from <= to ? 1.0 : -1.0;
  for (double t = 0.0; t < std::abs(to - from);
       t = static_cast<double>(rt::monotonicNow() - start_ns) * 1e-9) {
    const std::int64_t sent_ns = rt::monotonicNow();
    const std::uint64_t seq = tool.publish(path.at(from + direction * t));
    if (seq > 0) ++stats.sent;
    if (seq > 0 && samples != nullptr) samples->sent(seq, sent_ns);
    stats.wakeup.add(pacer.wait());
    if (client::stopRequested()) break;
  }
  stats.seconds = static_cast<double>(rt::monotonicNow() - start_ns) * 1e-9;
}

std::int64_t millisecondsSince1970() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

// Reads the fields of one run of a server into a log.
class FieldReader {
 public:
  FieldReader(const dds::Participant& participant, const MeasureOptions& options, LatencyLog& log)
      : options_(options), log_(log), reader_(participant, &FieldReader::onFields, this) {}

 private:
  static void onFields(dds::ReaderView<dds::SurfaceDisplacement> reader, void* context) noexcept {
    auto& self = *static_cast<FieldReader*>(context);
    const std::int64_t now_ns = rt::monotonicNow();
    const auto samples = reader.takeLoaned();
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (samples[i].session == self.options_.server.session)
        self.log_.addField(samples[i], self.options_.tool_id, now_ns);
  }

  const MeasureOptions& options_;
  LatencyLog& log_;
  dds::Reader<dds::SurfaceDisplacement> reader_;
};

}  // namespace

SenderStats measure(const dds::Participant& participant, const client::Spot& spot,
                    const MeasureOptions& options, LatencyLog& log) {
  const auto on_force = [](const dds::ToolForce& force, std::int64_t received_ns, void* context) noexcept {
    static_cast<LatencyLog*>(context)->add(force, received_ns);
  };
  const client::StatusBoard statuses(participant);
  std::optional<FieldReader> fields;
  if (options.fields) fields.emplace(participant, options, log);
  std::optional<client::ToolClient> tool;
  tool.emplace(participant, options.tool_id, on_force, &log, options.server);
  const device::Path path = gentlePress(spot, options);
  SenderStats unmeasured;
  SenderStats stats;
  std::optional<client::SendingPriority> priority(std::in_place, *tool);
  stats.realtime = priority->granted();
  rt::Pacer pacer(std::llround(1e9 / options.rate_hz));
  send(*tool, path, 0.0, kApproachSeconds, pacer, unmeasured);
  stats.start_ms = millisecondsSince1970();
  log.record(true);
  send(*tool, path, kApproachSeconds, kApproachSeconds + options.seconds, pacer, stats, options.samples);
  log.record(false);
  const std::int64_t end_ns = rt::monotonicNow();
  stats.interrupted = client::stopRequested();
  dds::ToolForce newest{};
  stats.server_left = tool->latest(newest) && (newest.flags & dds::flag::kShuttingDown) != 0;
  send(*tool, path, kApproachSeconds, 0.0, pacer, unmeasured);
  priority.reset();
  stats.left_out = tool->hold().leftOut();
  stats.model_changes = tool->modelChanges();
  stats.left_out_text = client::leftOutText(stats.left_out, statuses);
  tool.reset();  // no answer comes after this
  log.finish(end_ns);
  stats.server_left = stats.server_left || end_ns - log.newestAnswerNs() > kGoneAfter;
  return stats;
}

}  // namespace palpate::latency
