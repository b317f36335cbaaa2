// SPDX-License-Identifier: Apache-2.0
// palpate-latency: how long a pose takes to become a force, and how steadily the server ticks.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "assertion.h"
#include "hdr_log.h"
#include "latency_report.h"
#include "palpate/client/error.h"
#include "palpate/client/sending.h"
#include "palpate/client/server_finder.h"
#include "palpate/client/stop_signal.h"
#include "palpate/idl/reader.h"
#include "palpate/report/asked_place.h"
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
  std::string plot, hdr, junit, samples;
  std::vector<std::string> assertions;
};

void addOptions(program::Options line, Options& options) {
  line.add("--seconds", &options.measure.seconds, "how long to measure").range(0.1, 86400.0, "s");
  line.add("--rate", &options.measure.rate_hz, "poses a second").range(10.0, 4000.0, "Hz");
  line.add("--at", &options.at,
           "press the accessible node nearest to x,y,z, m; refused off the organ; default: the highest one");
  line.add("--tool", &options.measure.tool_id, "tool id, 0 to 3").range(0, 3);
  line.add("--domain", &options.domain, "DDS domain").range(0, 230);
  line.add("--server-id", &options.server_id, "which server of the domain; default: the first found");
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

// One line for each assertion that fails. Returns the program's exit code.
int judgeAll(const std::vector<Assertion>& assertions, const program::Json& report,
             const std::string& junit) {
  std::vector<Outcome> outcomes;
  for (const Assertion& assertion : assertions) outcomes.push_back(judge(assertion, report));
  if (!junit.empty()) program::writeFile(junit, junitOf(outcomes, report["seconds"].get<double>()));
  for (const Outcome& outcome : outcomes)
    if (!outcome.held) std::cerr << "palpate-latency: " << failureLine(outcome) << '\n';
  const bool all = std::all_of(outcomes.begin(), outcomes.end(), [](const Outcome& one) { return one.held; });
  return all ? 0 : program::kNotHeld;
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
  program::checkOutput("--plot", options.plot);
  program::checkOutput("--hdr", options.hdr);
  program::checkOutput("--junit", options.junit);
  program::checkOutput("--samples", options.samples);
  std::optional<SampleLog> samples = samplesOf(options);
  if (!options.at.empty()) (void)program::parseVector("--at", options.at);  // before it waits
  client::catchStopSignals();

  // 2. Find the server and a place to press.
  const dds::Participant participant(options.domain);
  client::ServerInfo server = client::findServer(participant, options.wait_s, options.server_id);
  const client::StatusBoard statuses(participant);
  const client::Spot spot =
      client::chooseSpot(server.surface, report::askedPlace(server.surface, "--at", options.at));
  options.measure.server = runOf(server);
  options.measure.tip_radius = server.status.tip_radius[options.measure.tool_id];

  // 3. Measure.
  const Interval interval{std::chrono::duration_cast<std::chrono::milliseconds>(
                              std::chrono::system_clock::now().time_since_epoch())
                              .count(),
                          options.measure.seconds};
  LatencyLog log(static_cast<std::int64_t>(1e9 / options.measure.rate_hz));
  if (samples) log.keepSamples(options.measure.samples = &*samples);
  const SenderStats sender = measure(participant, spot, options.measure, log);
  if (!sender.realtime) std::cerr << client::kNotRealtime;
  if (log.received() == 0)
    throw client::ClientError("no force came back for " + std::to_string(sender.sent) + " poses");

  server.status = statuses.find(runOf(server)).value_or(server.status);

  // 4. Tell.
  (options.json ? std::cerr : std::cout) << textOf(log, sender, server.status) << std::flush;
  const program::Json report = jsonOf(log, sender, server.status);
  if (options.json) program::printJson(report);
  if (!options.plot.empty()) program::writeFile(options.plot, plotOf(log));
  if (!options.hdr.empty()) program::writeFile(options.hdr, hdrLogOf(taggedTimesOf(log), interval));
  if (samples) program::writeFile(options.samples, samples->csv());
  return judgeAll(assertions, report, options.junit);
}

}  // namespace
}  // namespace palpate::latency

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-latency", &palpate::latency::body, argc, argv);
}
