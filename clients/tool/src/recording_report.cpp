// SPDX-License-Identifier: Apache-2.0
#include "recording_report.h"

#include <algorithm>
#include <vector>

#include "palpate/client/model_changes.h"
#include "palpate/client/time_summary.h"
#include "palpate/idl/printable.h"
#include "palpate/report/program.h"
#include "palpate/report/text_chart.h"
#include "tools/program/printed.h"
#include "tools/program/svg_plot.h"

namespace palpate::tool {
namespace {

using program::Json;
using program::printed;

double secondsOf(const ReplayedPose& pose) {
  return 1e-9 * static_cast<double>(pose.recorded->t_ns);
}

std::string rowOf(const ReplayedPose& pose) {
  const device::Point& x = pose.recorded->position;
  return printed("%7.3f  %8.2f %8.2f %8.2f  %9.4f  %9.4f  %9.5f  ", secondsOf(pose), x[0] * 1e3, x[1] * 1e3,
                 x[2] * 1e3, length(pose.recorded->force), length(pose.force()), pose.difference()) +
         report::flagNames(pose.now.flags) + '\n';
}

std::string summaryOf(const ReplayedTool& tool) {
  std::string text = printed(
      "%llu poses sent, %zu answered, %llu superseded, %llu forces lost; largest force %.4f N recorded, %.4f "
      "N "
      "now\n",
      static_cast<unsigned long long>(tool.sent), tool.poses.size(),
      static_cast<unsigned long long>(tool.superseded), static_cast<unsigned long long>(tool.answers.lost()),
      tool.largestRecorded(), tool.largestNow());
  const ReplayedPose* worst = tool.worst();
  if (worst == nullptr) return text + "no force can be compared\n";
  text += printed("largest difference %.5f N, at %.3f s", worst->difference(), secondsOf(*worst));
  if (tool.largestRecorded() > 0.0)
    text += printed(": %.2f %% of the largest force", 100.0 * worst->difference() / tool.largestRecorded());
  const std::uint64_t unanswered = tool.sent - tool.poses.size(),
                      stalled = tool.poses.size() - tool.compared();
  if (unanswered + stalled > 0)
    text += printed("; not compared: %llu poses without an answer of their own, %llu after a stall (%.1f %%)",
                    static_cast<unsigned long long>(unanswered), static_cast<unsigned long long>(stalled),
                    100.0 * static_cast<double>(unanswered + stalled) / static_cast<double>(tool.sent));
  return text + '\n';
}

std::string tableOf(const ReplayedTool& tool, bool by_stamp) {
  constexpr std::size_t kRows = 24;
  std::string text = printed("tool %u, sent as tool %u, timed by %s; force on the tool\n", tool.recorded_as,
                             tool.sent_as, by_stamp ? "its stamps" : "its arrival at the server");
  text += "   t / s      x/mm     y/mm     z/mm  recorded/N      now/N     diff/N  flags\n";
  const std::size_t count = tool.poses.size(), rows = std::min(kRows, count);
  for (std::size_t row = 0; row < rows; ++row)
    text += rowOf(tool.poses[row * (count - 1) / std::max<std::size_t>(rows - 1, 1)]);
  std::vector<double> t, f;
  for (const ReplayedPose& pose : tool.poses) {
    t.push_back(secondsOf(pose));
    f.push_back(length(pose.force()));
  }
  if (count > 0) text += '\n' + report::textChart(t, f, "s", "|force| now / N") + '\n';
  return text + summaryOf(tool);
}

Json jsonOf(const ReplayedTool& tool, const RecordedSession& session) {
  Json t = Json::array(), pose = t, orientation = t, buttons = t, recorded = t, force = t, flags = t,
       recorded_flags = t, compared = t;
  for (const ReplayedPose& one : tool.poses) {
    t.push_back(secondsOf(one));
    pose.push_back(one.recorded->position);
    orientation.push_back(one.recorded->orientation);
    buttons.push_back(one.recorded->buttons);
    recorded.push_back(one.recorded->force);
    force.push_back(one.force());
    flags.push_back(one.now.flags);
    recorded_flags.push_back(one.recorded->flags);
    compared.push_back(one.compared);
  }
  const ReplayedPose* worst = tool.worst();
  const double largest = tool.largestRecorded();
  return {{"tool", tool.recorded_as},
          {"sent_as", tool.sent_as},
          {"timed_by", session.by_stamp[tool.recorded_as] ? "stamps" : "arrivals"},
          {"t_s", t},
          {"pose_m", pose},
          {"orientation", orientation},
          {"buttons", buttons},
          {"recorded_force_N", recorded},
          {"force_N", force},
          {"flags", flags},
          {"recorded_flags", recorded_flags},
          {"compared", compared},
          {"summary",
           {{"sent", tool.sent},
            {"answered", tool.poses.size()},
            {"compared", tool.compared()},
            {"not_compared", tool.sent == 0 ? Json()
                                            : Json(1.0 - static_cast<double>(tool.compared()) /
                                                             static_cast<double>(tool.sent))},
            {"superseded", tool.superseded},
            {"received", tool.answers.received()},
            {"lost", tool.answers.lost()},
            {"largest_recorded_force_N", largest},
            {"largest_force_N", tool.largestNow()},
            {"largest_difference_N", worst == nullptr ? Json() : Json(worst->difference())},
            {"largest_difference_t_s", worst == nullptr ? Json() : Json(secondsOf(*worst))},
            {"largest_difference",
             worst == nullptr || !(largest > 0.0) ? Json() : Json(worst->difference() / largest)}}}};
}

}  // namespace

bool PlayedBack::isJudged() const noexcept {
  constexpr double kNoForce = 1e-3;  // N
  return playback.isWhole() &&
         std::any_of(playback.tools.begin(), playback.tools.end(),
                     [](const ReplayedTool& tool) { return tool.largestRecorded() > kNoForce; });
}

bool PlayedBack::holds() const noexcept {
  return within && isJudged() &&
         std::all_of(playback.tools.begin(), playback.tools.end(),
                     [this](const ReplayedTool& tool) { return tool.within(*within); });
}

std::string notesOf(const std::string& file, const RecordedSession& session, std::optional<std::uint32_t> as,
                    const client::ServerInfo& server) {
  std::string notes;
  const std::string model = dds::printable(server.status.model_id);
  if (model != session.model_id)
    notes += "note: " + file + " was recorded with model " + session.model_id + ", this server has model " +
             model + '\n';
  for (std::uint32_t tool = 0; tool < kTools; ++tool) {
    const double tip = server.status.tip_radius[as.value_or(tool)];
    if (session.has[tool] && tip != session.tip_radius[tool])
      notes += printed("note: tool %u was recorded with a tip radius of %g m, this server's is %g m\n", tool,
                       session.tip_radius[tool], tip);
  }
  if (session.changes > 0)
    notes += printed("note: parameters were set %llu times while it was recorded; they are not set now\n",
                     static_cast<unsigned long long>(session.changes));
  if (session.missing > 0)
    notes +=
        printed("note: %llu ticks are missing in it\n", static_cast<unsigned long long>(session.missing));
  if (session.truncated) notes += "note: it has no end: played as far as it goes\n";
  return notes;
}

std::string tableOf(const PlayedBack& played) {
  std::string text =
      printed("%s: %.1f s, recorded with engine ", played.file.c_str(), played.session.seconds()) +
      played.session.engine + '\n';
  for (const ReplayedTool& tool : played.playback.tools)
    text += tableOf(tool, played.session.by_stamp[tool.recorded_as]) + '\n';
  const client::TimeSummary late = client::summaryOf(played.playback.lateness);
  text += printed("poses were sent late by %.1f us (p50), %.1f us (p99), %.1f us at most\n", late.p50,
                  late.p99, late.max);
  text += played.playback.left_out_text + client::modelChangesText(played.playback.model_changes);
  if (played.playback.server_left) text += "the server shut down before the recording's end\n";
  return text;
}

Json jsonOf(const PlayedBack& played) {
  Json tools = Json::array();
  for (const ReplayedTool& tool : played.playback.tools) tools.push_back(jsonOf(tool, played.session));
  return {{"script", "recording"},
          {"recording", played.file},
          {"recorded_model_id", played.session.model_id},
          {"model_id", dds::printable(played.server.status.model_id)},
          {"engine", played.session.engine},
          {"seconds", played.session.seconds()},
          {"parameter_changes", played.session.changes},
          {"missing_ticks", played.session.missing},
          {"truncated", played.session.truncated},
          {"send_lateness_us", report::toJson(client::summaryOf(played.playback.lateness))},
          {"left_out", played.playback.left_out},
          {"model_changes", played.playback.model_changes},
          {"server_left", played.playback.server_left},
          {"interrupted", played.playback.interrupted},
          {"within", played.within ? Json(*played.within) : Json()},
          {"holds", played.within ? Json(played.holds()) : Json()},
          {"tools", tools}};
}

std::string plotOf(const PlayedBack& played) {
  program::SvgPlot plot;
  plot.title = "palpate-tool --script recording: size of the force on the tool";
  plot.x_label = "time / s";
  plot.y_label = "force / N";
  for (const ReplayedTool& tool : played.playback.tools) {
    program::Series recorded, now;
    recorded.name = printed("tool %u, recorded", tool.recorded_as);
    now.name = printed("tool %u, now", tool.recorded_as);
    for (const ReplayedPose& pose : tool.poses) {
      recorded.x.push_back(secondsOf(pose));
      recorded.y.push_back(length(pose.recorded->force));
      now.x.push_back(secondsOf(pose));
      now.y.push_back(length(pose.force()));
    }
    plot.series.push_back(recorded);
    plot.series.push_back(now);
  }
  return plot.render();
}

}  // namespace palpate::tool
