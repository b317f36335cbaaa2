// SPDX-License-Identifier: Apache-2.0
#include "list_report.h"

#include <algorithm>
#include <array>

#include "palpate/idl/printable.h"
#include "palpate/report/late_ticks.h"
#include "tools/program/printed.h"

namespace palpate::list {
namespace {

using program::Json;
using program::printed;

std::size_t toolsOf(const Server& server) {
  return std::min<std::size_t>(server.status.tools, server.devices.size());
}

std::string nameOf(const Publisher& publisher) {
  const std::string process = publisher.process.text();
  return process.empty() ? "a process that DDS does not name" : process;
}

std::string sendersOf(const Listing& listing, const Server& server, std::uint32_t tool) {
  std::string text;
  for (const Publisher& publisher : listing.publishers)
    if (isFor(publisher, server) && publisher.tool_id == tool)
      text += (text.empty() ? "" : "; ") + nameOf(publisher) + printed(", %.0f poses/s", publisher.rate_hz);
  return text.empty() ? "nobody sends" : text;
}

std::string organText(const Organ& organ) {
  std::string text = printed(
      "  organ %-3u %zu surface nodes, %zu accessible, %zu triangles, %.0f x %.0f x %.0f mm, model %s\n",
      organ.organ_id, organ.nodes, organ.accessible, organ.triangles, 1e3 * organ.size[0],
      1e3 * organ.size[1], 1e3 * organ.size[2], organ.model_id.c_str());
  for (const Organ::Region& region : organ.regions)
    text += printed("            %s, E %.4g kPa\n", region.name.c_str(), 1e-3 * region.youngs_modulus);
  return text;
}

struct NamedTimes {
  const char* name;
  const char* key;
  const dds::Percentiles* run;
  const dds::RecentTimes* recent;
};

std::array<NamedTimes, 4> timesOf(const dds::ServerStatus& status) {
  return {{{"tick", "tick", &status.tick_us, &status.tick_recent_us},
           {"woke late by", "wakeup", &status.wakeup_us, &status.wakeup_recent_us},
           {"pose received", "receive", &status.receive_us, &status.receive_recent_us},
           {"force sent", "force_out", &status.force_out_us, &status.force_out_recent_us}}};
}

std::string timesText(const NamedTimes& times) {
  const auto pair = [](const dds::Percentiles& over) { return printed("%.0f / %.0f", over.p50, over.p99); };
  return printed("  %-14s p50 / p99 us: run ", times.name) + pair(*times.run) + ", last minute " +
         pair(times.recent->minute) + ", last second " + pair(times.recent->second) + '\n';
}

std::string serverText(const Listing& listing, const Server& server) {
  const dds::ServerStatus& status = server.status;
  std::string text = client::describe(status) + printed("\n  %.0f Hz, ", status.rate_hz) +
                     (status.answers_any ? "answers poses that name it or no server\n"
                                         : "answers only poses that name it\n");
  for (const NamedTimes& times : timesOf(status)) text += timesText(times);
  text += "  late ticks " + report::lateText(status.late) + '\n';
  for (const Organ& organ : server.organs) text += organText(organ);
  if (server.organs.empty()) text += "  no organ's surface came yet\n";
  for (std::size_t tool = 0; tool < toolsOf(server); ++tool)
    text += printed("  tool %zu    %-10s tip %.1f mm, ", tool,
                    (server.devices[tool].empty() ? "?" : server.devices[tool]).c_str(),
                    1e3 * status.tip_radius[tool]) +
            sendersOf(listing, server, static_cast<std::uint32_t>(tool)) + '\n';
  return text;
}

// Of a pose whose server, or tool, is not there.
bool isTakenBySome(const Listing& listing, const Publisher& publisher) {
  return std::any_of(listing.servers.begin(), listing.servers.end(), [&](const Server& server) {
    return isFor(publisher, server) && publisher.tool_id < toolsOf(server);
  });
}

std::string strangerText(const Publisher& publisher) {
  if (!publisher.sends) return nameOf(publisher) + " could send poses, and sends none\n";
  return nameOf(publisher) + printed(" sends poses of tool %u for ", publisher.tool_id) +
         (publisher.server_id == dds::kServerAny ? "any server" : printed("server %u", publisher.server_id)) +
         ", which nobody takes\n";
}

Json organJson(const Organ& organ) {
  Json regions = Json::array();
  for (const Organ::Region& region : organ.regions)
    regions.push_back({{"name", region.name}, {"youngs_modulus_Pa", region.youngs_modulus}});
  return {{"organ_id", organ.organ_id},
          {"model_id", organ.model_id},
          {"surface_nodes", organ.nodes},
          {"accessible_nodes", organ.accessible},
          {"triangles", organ.triangles},
          {"size_m", organ.size},
          {"regions", regions}};
}

Json serverJson(const Server& server) {
  const dds::ServerStatus& status = server.status;
  Json json{{"server_id", status.server_id},
            {"session", printed("%016llx", static_cast<unsigned long long>(status.session))},
            {"host", dds::printable(status.host)},
            {"pid", status.pid},
            {"rate_hz", status.rate_hz},
            {"answers_any", status.answers_any},
            {"model_id", dds::printable(status.model_id)},
            {"times_us", Json::object()},
            {"late_ticks", report::toJson(status.late)},
            {"organs", Json::array()},
            {"tools", Json::array()}};
  for (const NamedTimes& times : timesOf(status))
    json["times_us"][times.key] = report::timesJson(*times.run, *times.recent);
  for (const Organ& organ : server.organs) json["organs"].push_back(organJson(organ));
  for (std::size_t tool = 0; tool < toolsOf(server); ++tool)
    json["tools"].push_back(
        {{"tool_id", tool},
         {"device", server.devices[tool].empty() ? Json(nullptr) : Json(server.devices[tool])},
         {"tip_radius_m", status.tip_radius[tool]}});
  return json;
}

Json publisherJson(const Publisher& publisher) {
  const bool any = publisher.server_id == dds::kServerAny;
  return {{"process", publisher.process.name},
          {"pid", publisher.process.pid},
          {"host", publisher.process.host},
          {"sends", publisher.sends},
          {"tool_id", publisher.sends ? Json(publisher.tool_id) : Json(nullptr)},
          {"server_id", publisher.sends && !any ? Json(publisher.server_id) : Json(nullptr)},
          {"poses", publisher.poses},
          {"rate_hz", publisher.rate_hz}};
}

}  // namespace

std::string textOf(const Listing& listing) {
  std::string text = printed("DDS domain %u: %zu servers, %zu publishers of poses\n", listing.domain,
                             listing.servers.size(), listing.publishers.size());
  for (const Server& server : listing.servers) text += serverText(listing, server);
  for (const Publisher& publisher : listing.publishers)
    if (!isTakenBySome(listing, publisher)) text += strangerText(publisher);
  return text;
}

Json jsonOf(const Listing& listing) {
  Json json{{"domain", listing.domain}, {"servers", Json::array()}, {"publishers", Json::array()}};
  for (const Server& server : listing.servers) json["servers"].push_back(serverJson(server));
  for (const Publisher& publisher : listing.publishers)
    json["publishers"].push_back(publisherJson(publisher));
  return json;
}

}  // namespace palpate::list
