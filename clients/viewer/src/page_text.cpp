// SPDX-License-Identifier: Apache-2.0
#include "page_text.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "page_message.h"
#include "palpate/report/late_ticks.h"
#include "palpate/report/program.h"
#include "tools/program/json.h"

namespace palpate::viewer {
namespace {

using program::Json;

Json flagList(std::uint32_t flags) {
  Json names = Json::array();
  std::istringstream words(flags == 0 ? "" : report::flagNames(flags));
  for (std::string word; words >> word;) names.push_back(word);
  return names;
}

Json toJson(const dds::Percentiles& times) {
  return report::toJson(report::summaryOf(times));
}

Json serverOf(const dds::ServerStatus& s) {
  return {{"server_id", s.server_id},
          {"model_id", s.model_id},
          {"organ_id", s.organ_id},
          {"state", s.state},
          {"rate_hz", s.rate_hz},
          {"tip_radius", s.tip_radius[0]},
          {"memory_locked", s.memory_locked},
          {"realtime", s.realtime},
          {"realtime_detail", s.realtime_detail},
          {"ticks", s.ticks},
          {"overruns", s.overruns},
          {"superseded", s.superseded},
          {"rejected_poses", s.rejected_poses},
          {"unordered_poses", s.unordered_poses},
          {"unknown_tools", s.unknown_tools},
          {"dropped", s.dropped},
          {"flags", s.flags},
          {"flags_text", flagList(s.flags)},
          {"tick_us", toJson(s.tick_us)},
          {"wakeup_us", toJson(s.wakeup_us)},
          {"receive_us", toJson(s.receive_us)},
          {"force_out_us", toJson(s.force_out_us)},
          {"tick_minute_us", toJson(s.tick_recent_us.minute)},
          {"wakeup_minute_us", toJson(s.wakeup_recent_us.minute)},
          {"receive_minute_us", toJson(s.receive_recent_us.minute)},
          {"force_out_minute_us", toJson(s.force_out_recent_us.minute)},
          {"tick_second_us", toJson(s.tick_recent_us.second)},
          {"wakeup_second_us", toJson(s.wakeup_recent_us.second)},
          {"receive_second_us", toJson(s.receive_recent_us.second)},
          {"force_out_second_us", toJson(s.force_out_recent_us.second)},
          {"late_ticks", report::toJson(s.late)},
          {"clock_steps", s.clock_steps},
          {"message", s.message},
          {"device", s.device},
          {"speed_limit", s.speed_limit},
          {"tools", s.tools},
          {"parameters_revision", s.parameters_revision},
          {"phase_lock", s.phase_lock}};
}

/// Live parameters by their names, from ServerStatus or one tool's of ServerParameters.
template <class Message>
void addLive(const Message& message, Json& object) {
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
    object[kLiveParameters[i].name] = message.*kLiveFields<Message>[i];
}

// What every tool allows: the page asks for all of them.
std::array<double, 2> limitsOf(const dds::ServerParameters& parameters, double dds::LiveValues::*bound) {
  std::array<double, 2> common{parameters.tools[0].lowest.*bound, parameters.tools[0].highest.*bound};
  for (const dds::ToolParameters& tool : parameters.tools) {
    common[0] = std::max(common[0], tool.lowest.*bound);
    common[1] = std::min(common[1], tool.highest.*bound);
  }
  return common;
}

Json boxOf(const client::Surface& surface) {
  device::Point low = surface.positions.front();
  device::Point high = low;
  for (const device::Point& X : surface.positions)
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], X[i]);
      high[i] = std::max(high[i], X[i]);
    }
  return std::array{low, high};
}

Json regionsOf(const client::Surface& surface) {
  Json regions = Json::array();
  for (const client::Region& region : surface.regions)
    regions.push_back({{"name", region.name}, {"youngs_modulus", region.youngs_modulus}});
  return regions;
}

}  // namespace

std::string helloText(std::uint64_t page_id, double rate_hz) {
  return Json({{"type", "hello"},
               {"version", PALPATE_VERSION},
               {"protocol", 2},
               {"page_id", page_id},
               {"rate_hz", rate_hz},
               {"max_message", kMaxMessage}})
      .dump();
}

std::string stateText(const ServerState& state) {
  return Json({{"type", "state"}, {"server", state.name}, {"text", state.text}, {"others", state.others}})
      .dump();
}

std::string meshText(const client::Surface& surface, std::uint32_t revision, double tip_radius) {
  return Json({{"type", "mesh"},
               {"revision", revision},
               {"model_id", surface.model_id},
               {"nodes", surface.positions.size()},
               {"triangles", surface.triangles.size()},
               {"tip_radius", tip_radius},
               {"box", boxOf(surface)},
               {"certificate", surface.certificate},
               {"regions", regionsOf(surface)}})
      .dump();
}

std::string statusText(const std::optional<dds::ServerStatus>& status,
                       const std::optional<dds::ServerParameters>& parameters, const ViewerFigures& figures) {
  Json object = status ? serverOf(*status) : Json::object();
  if (status) addLive(*status, object);
  if (parameters) {  // newer than those in the status
    addLive(parameters->tools[0].now, object);
    object["model_youngs_modulus"] = parameters->model_youngs_modulus;
    object["parameters_revision"] = parameters->revision;
    object["parameters_open"] = parameters->open;
    for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
      const auto bound = kLiveFields<dds::LiveValues>[i];
      object["limits"][kLiveParameters[i].name] = limitsOf(*parameters, bound);
    }
  }
  object["type"] = "status";
  object["viewer"] = {{"pages", figures.pages},
                      {"frame_rate", figures.frame_rate},
                      {"dropped_fields", figures.dropped_fields}};
  return object.dump();
}

std::string toolText(const ToolGrant& grant) {
  Json object{{"type", "tool"}, {"granted", grant.granted}, {"message", grant.message}};
  object["tool_id"] = grant.granted ? Json(grant.tool_id) : Json();
  return object.dump();
}

std::string parametersText(std::uint64_t request, bool accepted, const std::string& message) {
  return Json({{"type", "parameters"}, {"request", request}, {"accepted", accepted}, {"message", message}})
      .dump();
}

std::string pongText(double t0, double t_us) {
  return Json({{"type", "pong"}, {"t0", t0}, {"t_us", t_us}}).dump();
}

}  // namespace palpate::viewer
