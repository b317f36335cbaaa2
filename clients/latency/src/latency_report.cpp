// SPDX-License-Identifier: Apache-2.0
#include "latency_report.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "palpate/client/model_changes.h"
#include "palpate/client/time_summary.h"
#include "palpate/report/late_ticks.h"
#include "palpate/report/program.h"
#include "palpate/report/text_chart.h"
#include "tools/program/printed.h"
#include "tools/program/svg_plot.h"

namespace palpate::latency {
namespace {

using client::summaryOf;

std::string rowOf(const char* name, const client::TimeSummary& s) {
  return program::printed("%-28s %9.1f %9.1f %9.1f %9.1f %9llu\n", name, s.p50, s.p99, s.p999, s.max,
                          static_cast<unsigned long long>(s.count));
}

// Of the server's run, beside its last minute and second.
std::string recentRowsOf(const std::string& what, const dds::Percentiles& run,
                         const dds::RecentTimes& recent) {
  return rowOf((what + ", run").c_str(), report::summaryOf(run)) +
         rowOf("  its last minute", report::summaryOf(recent.minute)) +
         rowOf("  its last second", report::summaryOf(recent.second));
}

const char* phaseName(const dds::ServerStatus& server) {
  switch (server.phase_lock) {
    case dds::phase::kFree:
      return "free";
    case dds::phase::kSeeking:
      return "seeking";
    case dds::phase::kLocked:
      return "locked";
    case dds::phase::kWaiting:
      return "waiting";
    default:
      return "off";
  }
}

// Where few are worse than many.
bool isWorstAtLeast(std::string_view key) {
  constexpr std::array kKeys{"count", "sent", "received", "seconds", "server_rate_hz"};
  return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

program::Json worse(std::string_view key, const program::Json& a, const program::Json& b) {
  if (a.isObject()) {
    program::Json all = program::Json::object();
    for (const auto& [name, value] : a.members()) all[name] = worse(name, value, b[name]);
    return all;
  }
  if (a.isNull() || b.isNull()) return {};
  if (a.isBool()) {
    const bool true_is_worse = key == "server_left" || key == "interrupted";
    return true_is_worse ? a.get<bool>() || b.get<bool>() : a.get<bool>() && b.get<bool>();
  }
  if (!a.isNumber()) return a;
  const bool a_is_less = a.get<double>() < b.get<double>();
  return a_is_less == isWorstAtLeast(key) ? a : b;
}

program::Series barsOf(const std::string& name, const rt::CycleStats& histogram) {
  program::Series series{name, {}, {}, {}};
  for (const auto& bar : client::barsOf(histogram, 10)) {
    series.x.push_back(bar.from_ns * 1e-3);
    series.x_end.push_back(bar.to_ns * 1e-3);
    series.y.push_back(static_cast<double>(bar.count));
  }
  return series;
}

}  // namespace

std::string textOf(const LatencyLog& log, const SenderStats& sender, const dds::ServerStatus& server) {
  std::string text = "time / us                          p50       p99     p99.9       max     count\n";
  text += rowOf("pose to force, round trip", summaryOf(log.poseToForce()));
  text += rowOf("  of answered poses", summaryOf(log.answeredPoseToForce()));
  text += rowOf("  of it the wait for a tick", summaryOf(log.wait()));
  text += rowOf("  less that wait", summaryOf(log.poseToForceLessWait()));
  if (log.poseToField().count() > 0) text += rowOf("pose to field", summaryOf(log.poseToField()));
  text += rowOf("tick, compute time", summaryOf(log.tick()));
  text += rowOf("tick, woke late by", summaryOf(log.wakeup()));
  text += recentRowsOf("server's tick, compute", server.tick_us, server.tick_recent_us);
  text += recentRowsOf("server's tick, woke late by", server.wakeup_us, server.wakeup_recent_us);
  text += recentRowsOf("pose received", server.receive_us, server.receive_recent_us);
  text += recentRowsOf("force sent", server.force_out_us, server.force_out_recent_us);
  text += rowOf("sender, woke late by", summaryOf(sender.wakeup));
  text += program::printed(
      "%.2f s at %g Hz: %llu poses, %llu forces, lost %llu, late %llu, superseded %llu, overruns %llu\n",
      sender.seconds, server.rate_hz, static_cast<unsigned long long>(sender.sent),
      static_cast<unsigned long long>(log.received()), static_cast<unsigned long long>(log.lost()),
      static_cast<unsigned long long>(log.late()), static_cast<unsigned long long>(log.superseded()),
      static_cast<unsigned long long>(log.overruns()));
  text += "late ticks: " + report::lateText(server.late) + "\n";
  text += sender.left_out_text + client::modelChangesText(sender.model_changes);
  text += std::string("real-time priority: server ") + (server.realtime ? "yes" : "no") + ", sender " +
          (sender.realtime ? "yes" : "no") +
          "; server's memory locked: " + (server.memory_locked ? "yes" : "no") + "\n";
  text += std::string("phase lock: ") + phaseName(server) + "\n\n";
  return text + "pose to force:\n" + report::textHistogram(log.poseToForce());
}

program::Json jsonOf(const LatencyLog& log, const SenderStats& sender, const dds::ServerStatus& server) {
  return {{"pose_to_force_us", report::toJson(summaryOf(log.poseToForce()))},
          {"answered_pose_to_force_us", report::toJson(summaryOf(log.answeredPoseToForce()))},
          {"pose_wait_us", report::toJson(summaryOf(log.wait()))},
          {"pose_to_force_less_wait_us", report::toJson(summaryOf(log.poseToForceLessWait()))},
          {"pose_to_field_us", report::toJson(summaryOf(log.poseToField()))},
          {"wakeup_us", report::toJson(summaryOf(log.wakeup()))},
          {"tick_us", report::toJson(summaryOf(log.tick()))},
          {"receive_us", report::toJson(report::summaryOf(server.receive_recent_us.minute))},
          {"force_out_us", report::toJson(report::summaryOf(server.force_out_recent_us.minute))},
          {"server_times_us",
           {{"tick", report::timesJson(server.tick_us, server.tick_recent_us)},
            {"wakeup", report::timesJson(server.wakeup_us, server.wakeup_recent_us)},
            {"receive", report::timesJson(server.receive_us, server.receive_recent_us)},
            {"force_out", report::timesJson(server.force_out_us, server.force_out_recent_us)}}},
          {"late_ticks", report::toJson(server.late)},
          {"phase_lock", phaseName(server)},
          {"client_wakeup_us", report::toJson(summaryOf(sender.wakeup))},
          {"overruns", log.overruns()},
          {"lost", log.lost()},
          {"late", log.late()},
          {"left_out", sender.left_out.count},
          {"model_changes", sender.model_changes},
          {"superseded", log.superseded()},
          {"seconds", sender.seconds},
          {"server_left", sender.server_left},
          {"interrupted", sender.interrupted},
          {"sent", sender.sent},
          {"received", log.received()},
          {"server_restarts", log.restarts()},
          {"client_realtime", sender.realtime},
          {"server_realtime", server.realtime},
          {"server_memory_locked", server.memory_locked},
          {"server_rate_hz", server.rate_hz},
          {"model_id", server.model_id}};
}

program::Json worstOf(const std::vector<program::Json>& tools) {
  program::Json worst = tools.front();
  for (const program::Json& tool : tools) worst = worse({}, worst, tool);
  program::Json all = program::Json::object();
  for (const auto& [key, value] : worst.members())
    if (key != "tool_id") all[key] = value;  // no figure
  all["tools"] = tools;
  return all;
}

std::vector<TaggedTimes> taggedTimesOf(const LatencyLog& log, const std::string& suffix) {
  return {{"pose_to_force" + suffix, &log.poseToForce()},
          {"answered_pose_to_force" + suffix, &log.answeredPoseToForce()},
          {"pose_to_field" + suffix, &log.poseToField()},
          {"wakeup" + suffix, &log.wakeup()},
          {"tick" + suffix, &log.tick()}};
}

std::string plotOf(const std::vector<std::pair<std::uint32_t, const LatencyLog*>>& logs) {
  program::SvgPlot plot;
  plot.title = "palpate-latency: " + std::to_string(logs.front().second->received()) + " ticks";
  plot.x_label = "time / us";
  plot.y_label = "samples";
  plot.log_x = true;
  plot.log_y = true;
  for (const auto& [tool, log] : logs) {
    const std::string whose = logs.size() > 1 ? ", tool " + std::to_string(tool) : "";
    plot.series.push_back(barsOf("pose to force" + whose, log->poseToForce()));
    if (plot.series.size() > 1) continue;  // the tick is the same for all
    plot.series.push_back(barsOf("tick, late by", log->wakeup()));
    plot.series.push_back(barsOf("tick, compute", log->tick()));
  }
  return plot.render();
}

}  // namespace palpate::latency
