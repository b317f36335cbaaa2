// SPDX-License-Identifier: Apache-2.0
// palpate-latency: how long a pose takes to become a force, and how steadily the server ticks.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "assertion.h"
#include "hdr_log.h"
#include "latency_report.h"
#include "palpate/client/error.h"
#include "palpate/client/joining.h"
#include "palpate/client/sending.h"
#include "palpate/client/server_finder.h"
#include "palpate/client/stop_signal.h"
#include "palpate/idl/reader.h"
#include "palpate/report/asked_place.h"
#include "palpate/report/late_ticks.h"
#include "tools.h"
#include "tools/program/command_line.h"
#include "tools/program/json.h"
#include "tools/program/numbers.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"

namespace palpate::latency {
namespace {

struct Options {
  MeasureOptions measure;
  int tools{1};
  std::string at;
  std::uint32_t domain{0};
  std::filesystem::path security;
  client::WantedServer wanted;
  double wait_s{10.0};
  bool json{false};
  std::string plot, hdr, junit, samples;
  std::vector<std::string> assertions;
};

void addOptions(program::Options line, Options& options) {
  line.add("--seconds", &options.measure.seconds, "how long to measure").range(0.1, 86400.0, "s");
  line.add("--rate", &options.measure.rate_hz, "poses a second").range(10.0, 4000.0, "Hz");
  line.add("--at", &options.at,
           "press the accessible node nearest to x,y,z, m; refused off the organ; default: the highest one");
  line.add("--tool", &options.measure.tool_id, "tool id, 0 to 3; with --tools the lowest").range(0, 3);
  line.add("--tools", &options.tools,
           "tools at once, far from each other; --assert holds where it holds for each, --json has the worst "
           "and "
           "each")
      .range(1, 4);
  line.add("--domain", &options.domain, "DDS domain").range(0, 230);
  line.add("--security", &options.security, client::kSecurityHelp).valueName("FOLDER");
  line.add("--server-id", &options.wanted.server_id, "which server of the domain; default: the first found")
      .range(std::int64_t{0}, client::kMaxServerId);
  line.add("--organ-id", &options.wanted.organ_id, client::kOrganIdHelp)
      .range(std::int64_t{0}, client::kMaxOrganId);
  line.add("--wait", &options.wait_s, "how long to wait for a server").range(0.0, 3600.0, "s");
  line.flag("--json", &options.json, "print one JSON object on standard output");
  line.flag("--fields", &options.measure.fields,
            "read the surface too: how long a pose takes to become a field");
  line.add("--plot", &options.plot, "write the histograms to this SVG file");
  line.add("--assert", &options.assertions,
           "a bound on a figure of --json, as in 'pose_to_force_us.p99<500' or 'lost==0'; may be given again")
      .oneWordEach()
      .valueName("BOUND");
  line.add("--hdr", &options.hdr, "write the distributions as an HdrHistogram log, values in ns");
  line.add(
      "--samples", &options.samples,
      "write when each pose was sent and answered as CSV, for palpate-device and palpate-feel --delay-from");
  line.add("--junit", &options.junit, "write what --assert found as JUnit XML");
}

// Room for all poses, or nothing. @throw program::UsageError  too many
std::optional<SampleLog> samplesOf(const Options& options) {
  if (options.samples.empty()) return std::nullopt;
  const auto poses = static_cast<std::size_t>(options.measure.seconds * options.measure.rate_hz) + 1000;
  if (poses > SampleLog::kMost)
    throw program::UsageError("--samples " + options.samples + ": " + std::to_string(poses) +
                              " poses, at most " + std::to_string(SampleLog::kMost) + " are kept");
  return SampleLog(poses);
}

std::vector<Assertion> readAssertions(const Options& options) {
  if (!options.junit.empty() && options.assertions.empty())
    throw program::UsageError("--junit " + options.junit + ": needs at least one --assert");
  const program::Json shape = jsonOf(LatencyLog(1), {}, {});
  std::vector<Assertion> read;
  for (const std::string& text : options.assertions) read.push_back(parseAssertion(text, shape));
  return read;
}

// One line for each assertion that fails. What was not measured to its end holds none. Returns the program's exit code.
int judgeAll(const std::vector<Assertion>& assertions, const std::vector<program::Json>& tools,
             const program::Json& worst, const std::string& junit) {
  const bool server_left = worst["server_left"].get<bool>(), interrupted = worst["interrupted"].get<bool>();
  const bool complete = !server_left && !interrupted;
  std::vector<Outcome> outcomes;
  for (const Assertion& assertion : assertions)
    outcomes.push_back(complete ? judgeEach(assertion, tools)
                                : Outcome{assertion, false, "not measured to the end"});
  if (!junit.empty()) program::writeFile(junit, junitOf(outcomes, worst["seconds"].get<double>()));
  for (const Outcome& outcome : outcomes)
    if (!outcome.held) std::cerr << "palpate-latency: " << failureLine(outcome) << '\n';
  if (server_left) std::cerr << "palpate-latency: the server left before the end\n";
  if (server_left || (interrupted && !assertions.empty())) return program::kFailed;
  const bool all = std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome& one) { return one.held; });
  return all ? program::kDone : program::kNotHeld;
}

struct Told {
  std::string text;
  std::vector<program::Json> reports;
  std::vector<TaggedTimes> times;
  std::vector<std::pair<std::uint32_t, const LatencyLog*>> logs;
};

Told toldOf(const std::vector<std::unique_ptr<ToolMeasurement>>& tools, const dds::ServerStatus& server) {
  Told told;
  for (const auto& tool : tools) {
    const std::string id = std::to_string(tool->tool_id);
    if (tools.size() > 1) told.text += (told.text.empty() ? "tool " : "\ntool ") + id + '\n';
    told.text += textOf(tool->log, tool->sender, server);
    program::Json report{{"tool_id", tool->tool_id}};
    const program::Json figures = jsonOf(tool->log, tool->sender, server);
    for (const auto& [key, value] : figures.members()) report[key] = value;
    told.reports.push_back(std::move(report));
    for (const auto& times : taggedTimesOf(tool->log, tools.size() > 1 ? "_tool" + id : ""))
      told.times.push_back(times);
    told.logs.emplace_back(tool->tool_id, &tool->log);
  }
  return told;
}

// @return the program's exit code
int tell(const Options& options, const std::vector<Assertion>& assertions,
         const std::vector<std::unique_ptr<ToolMeasurement>>& tools, const dds::ServerStatus& server) {
  const Told told = toldOf(tools, server);
  (options.json ? std::cerr : std::cout) << told.text << std::flush;
  const program::Json worst = worstOf(told.reports);
  if (options.json) program::printJson(worst);
  if (!options.plot.empty()) program::writeFile(options.plot, plotOf(told.logs));
  const SenderStats& first = tools.front()->sender;
  if (!options.hdr.empty())
    program::writeFile(options.hdr, hdrLogOf(told.times, {first.start_ms, first.seconds}));
  return judgeAll(assertions, told.reports, worst, options.junit);
}

int body(int argc, char** argv) {
  // 1. What to do.
  program::CommandLine line(
      "palpate-latency",
      "Sends poses to a palpate-server and measures round trip, tick time and wake-up lateness.");
  Options options;
  addOptions(line.options(), options);
  line.footer(
      "pose_to_force_us is corrected for coordinated omission. An assertion that fails is told in one line.\n"
      "Example: palpate-latency --seconds 60 --assert 'pose_to_force_us.p99<2000' --assert 'lost==0' --junit "
      "latency.xml");
  if (!line.read(argc, argv)) return program::kDone;
  const std::vector<Assertion> assertions = readAssertions(options);
  if (options.measure.tool_id + static_cast<std::uint32_t>(options.tools) > 4)
    throw program::UsageError("--tools " + std::to_string(options.tools) + " with --tool " +
                              std::to_string(options.measure.tool_id) + ": ids end at 3");
  if (options.tools > 1 && !options.samples.empty())
    throw program::UsageError("--samples " + options.samples + ": keeps the poses of one tool, --tools is " +
                              std::to_string(options.tools));
  program::checkOutput("--plot", options.plot);
  program::checkOutput("--hdr", options.hdr);
  program::checkOutput("--junit", options.junit);
  program::checkOutput("--samples", options.samples);
  std::optional<SampleLog> samples = samplesOf(options);
  if (!options.at.empty()) (void)program::parseVector("--at", options.at);  // before it waits
  client::catchStopSignals();

  // 2. Find the server and a place to press.
  const dds::Participant participant = client::join(options.domain, options.security, {dds::Role::kDriver});
  client::ServerInfo server = client::findServer(participant, options.wait_s, options.wanted);
  const client::StatusBoard statuses(participant);
  const std::vector<client::Spot> spots =
      spotsApart(server.surface,
                 client::chooseSpot(server.surface, report::askedPlace(server.surface, "--at", options.at)),
                 static_cast<std::size_t>(options.tools));

  // 3. Measure.
  const dds::LateTicks late_before = server.status.late;
  if (samples) options.measure.samples = &*samples;
  const auto tools = measureTogether(participant, server, spots, options.measure);
  if (samples) program::writeFile(options.samples, samples->csv());
  const bool realtime =
      std::all_of(tools.begin(), tools.end(), [](const auto& tool) { return tool->sender.realtime; });
  if (!realtime) std::cerr << client::kNotRealtime;
  server.status = statuses.find(runOf(server)).value_or(server.status);
  server.status.late = report::lateSince(late_before, server.status.late);

  // 4. Tell.
  return tell(options, assertions, tools, server.status);
}

}  // namespace
}  // namespace palpate::latency

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-latency", &palpate::latency::body, argc, argv);
}
