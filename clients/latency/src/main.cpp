// SPDX-License-Identifier: Apache-2.0
// palpate-latency: how long a pose takes to become a force, and how steadily the server ticks.
#include <iostream>
#include <optional>

#include "core/devices/path/path.h"
#include "latency_report.h"
#include "palpate/client/error.h"
#include "palpate/client/sending.h"
#include "palpate/client/server_finder.h"
#include "palpate/client/stop_signal.h"
#include "palpate/idl/reader.h"
#include "tools/program/command_line.h"
#include "tools/program/json.h"
#include "tools/program/numbers.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"

namespace palpate::latency {
namespace {

struct Options {
  MeasureOptions measure;
  std::string at;
  std::uint32_t domain{0};
  std::uint32_t server_id{dds::kServerAny};
  double wait_s{10.0};
  bool json{false};
  std::string plot;
};

void addOptions(program::Options line, Options& options) {
  line.add("--seconds", &options.measure.seconds, "how long to measure, s").range(0.1, 86400.0);
  line.add("--rate", &options.measure.rate_hz, "poses a second").range(10.0, 4000.0);
  line.add("--at", &options.at, "press the accessible node nearest to x,y,z (m); default: the highest one");
  line.add("--tool", &options.measure.tool_id, "tool id, 0 to 3").range(0, 3);
  line.add("--domain", &options.domain, "DDS domain").range(0, 230);
  line.add("--server-id", &options.server_id, "which server of the domain; default: the first found");
  line.add("--wait", &options.wait_s, "how long to wait for a server, s").range(0.0, 3600.0);
  line.flag("--json", &options.json, "print one JSON object on standard output");
  line.flag("--fields", &options.measure.fields,
            "read the surface too: how long a pose takes to become a field");
  line.add("--plot", &options.plot, "write the histograms to this SVG file");
}

int body(int argc, char** argv) {
  // 1. What to do.
  program::CommandLine line(
      "palpate-latency",
      "Sends poses to a palpate-server and measures round trip, tick time and wake-up lateness.");
  Options options;
  addOptions(line.options(), options);
  if (!line.read(argc, argv)) return 0;
  std::optional<device::Point> at;
  if (!options.at.empty()) at = device::Point{program::parseVector("--at", options.at)};
  client::catchStopSignals();

  // 2. Find the server and a place to press.
  const dds::Participant participant(options.domain);
  client::ServerInfo server = client::findServer(participant, options.wait_s, options.server_id);
  const client::StatusBoard statuses(participant);
  const client::Spot spot = client::chooseSpot(server.surface, at);
  options.measure.server = runOf(server);
  options.measure.tip_radius = server.status.tip_radius[options.measure.tool_id];

  // 3. Measure.
  LatencyLog log(static_cast<std::int64_t>(1e9 / options.measure.rate_hz));
  const SenderStats sender = measure(participant, spot, options.measure, log);
  if (!sender.realtime) std::cerr << client::kNotRealtime;
  if (log.received() == 0)
    throw client::ClientError("no force came back for " + std::to_string(sender.sent) + " poses");

  server.status = statuses.find(runOf(server)).value_or(server.status);

  // 4. Tell.
  (options.json ? std::cerr : std::cout) << textOf(log, sender, server.status) << std::flush;
  if (options.json) program::printJson(jsonOf(log, sender, server.status));
  if (!options.plot.empty()) program::writeFile(options.plot, plotOf(log));
  return 0;
}

}  // namespace
}  // namespace palpate::latency

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-latency", &palpate::latency::body, argc, argv);
}
