// SPDX-License-Identifier: Apache-2.0
// palpate-tool: a scripted tool, or the tools of a recorded session, touch the organ; prints the force over time.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <optional>
#include <thread>

#include "palpate/client/error.h"
#include "palpate/client/joining.h"
#include "palpate/client/place.h"
#include "palpate/client/sending.h"
#include "palpate/client/stop_signal.h"
#include "palpate/report/asked_place.h"
#include "play_recording.h"
#include "recording_report.h"
#include "tool_report.h"
#include "tools/program/command_line.h"
#include "tools/program/json.h"
#include "tools/program/numbers.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"

namespace palpate::tool {
namespace {

/// A server keeps a tool for its sender until it has been silent for at most this long (StepConfig::zero_after).
constexpr std::chrono::milliseconds kLetGo{50};

struct Options {
  std::string script{"press"};
  std::string recording;
  std::optional<int> recorded_tool;
  std::optional<double> within;  ///< percent
  bool partial{false};
  std::optional<double> depth, slide, clearance;  ///< m; absent: those of ScriptOptions
  std::optional<int> pokes;
  std::optional<double> seconds;     ///< of the whole script, in (0, 3600]
  std::optional<double> tip_radius;  ///< m; absent: the server's
  std::string at, beside;
  std::optional<int> tool_id;
  std::uint32_t domain{0};
  std::filesystem::path security;
  client::WantedServer wanted;
  double wait_s{10.0};
  bool json{false};
  std::string plot;

  [[nodiscard]] bool playsRecording() const { return script == "recording"; }
  [[nodiscard]] std::uint32_t tool() const { return static_cast<std::uint32_t>(tool_id.value_or(0)); }
};

void addOptions(program::Options line, Options& options) {
  line.add("--script", &options.script, "what to play: press, slide, poke, or the recording FILE")
      .oneOf({"press", "slide", "poke", "recording"});
  line.add("FILE", &options.recording, "recording of palpate-server --record, for --script recording");
  line.add("--recorded-tool", &options.recorded_tool,
           "of a recording: play this tool only; default: all that were recorded")
      .range(0, 3);
  line.add("--within", &options.within,
           "of a recording: exit code 3 where a force differs by more than this share of the largest; "
           "default: none")
      .range(0.0, 100.0, "%");
  line.flag("--partial", &options.partial, "play a recording although ticks or its end are missing");
  line.add(
          "--seconds", &options.seconds,
          "duration of the whole script; default: the script's own; of a recording: how much of it is played")
      .range(0.05, 3600.0, "s");
  line.add("--depth", &options.depth, "depth of the tip below the rest surface; default: 0.003")
      .range(1e-6, 0.05, "m");
  line.add("--slide", &options.slide, "distance along the surface; default: 0.01").range(1e-6, 0.1, "m");
  line.add("--pokes", &options.pokes, "number of times that poke goes in; default: 4").range(1, 10000);
  line.add("--clearance", &options.clearance, "distance at the start and the end; default: 0.01")
      .range(1e-6, 0.2, "m");
  line.add("--at", &options.at,
           "touch the accessible node nearest to x,y,z, m; refused off the organ; default: the highest one");
  line.add("--beside", &options.beside,
           "then play the same at x,y,z (m); both are told, the plot shows both forces over depth");
  line.add("--tip-radius", &options.tip_radius, "radius of the tip; default: the server's")
      .range(0.0, 0.05, "m");
  line.add("--tool", &options.tool_id, "tool id, 0 to 3; default: 0, of a recording as recorded").range(0, 3);
  line.add("--domain", &options.domain, "DDS domain").range(0, 230);
  line.add("--security", &options.security, client::kSecurityHelp).valueName("FOLDER");
  line.add("--server-id", &options.wanted.server_id, "which server of the domain; default: the first found")
      .range(std::int64_t{0}, client::kMaxServerId);
  line.add("--organ-id", &options.wanted.organ_id, client::kOrganIdHelp)
      .range(std::int64_t{0}, client::kMaxOrganId);
  line.add("--wait", &options.wait_s, "how long to wait for a server").range(0.0, 3600.0, "s");
  line.flag("--json", &options.json, "print one JSON object on standard output");
  line.add("--plot", &options.plot, "write the force over time to this SVG file");
  line.example(
      "palpate-tool --script press --depth 0.003 --plot press.svg\n"
      "         palpate-tool --script recording session.rec --within 1");
}

Played prepare(const Options& options, const std::optional<device::Point>& place,
               const client::ServerInfo& server) {
  client::ScriptOptions path_options;
  path_options.depth = options.depth.value_or(path_options.depth);
  path_options.slide_distance = options.slide.value_or(path_options.slide_distance);
  path_options.clearance = options.clearance.value_or(path_options.clearance);
  path_options.pokes = options.pokes.value_or(path_options.pokes);
  path_options.tip_radius = options.tip_radius.value_or(server.status.tip_radius[options.tool()]);
  if (path_options.tip_radius != server.status.tip_radius[options.tool()])
    std::cerr << "note: tip radius " << path_options.tip_radius << " m differs from the server's "
              << server.status.tip_radius[options.tool()] << " m\n";
  const client::Spot spot = client::chooseSpot(server.surface, place);
  device::Path path = client::scriptedPath(options.script, spot, path_options);
  if (options.seconds) path = path.stretchedTo(*options.seconds);
  return {options.script, path_options, spot, std::move(path), server};
}

/// Scripts touch the organ. @return kFailed when none of the answers was of a contact, with a line that says how near the tool
/// came, and when the server left; a script that was stopped is no failure
int verdictOn(const Recording& recording, const client::Surface& surface) {
  if (recording.server_left) return program::kFailed;
  if (client::stopRequested()) return program::kDone;
  const auto touches = [](const Sample& sample) { return (sample.force.flags & dds::flag::kInContact) != 0; };
  if (std::any_of(recording.samples.begin(), recording.samples.end(), touches)) return program::kDone;
  const double nearest =
      client::nearestOf(surface, recording.samples, [](const Sample& sample) { return sample.pose; });
  std::cerr << "palpate-tool: " << report::neverTouchedText(nearest) << '\n';
  return program::kFailed;
}

// A path's options say nothing of a recording, nor a recording's of a path.
void checkRecordingOptions(const Options& options) {
  if (!options.playsRecording()) {
    if (!options.recording.empty())
      throw program::UsageError(options.recording + ": only --script recording plays a file");
    if (options.recorded_tool || options.within || options.partial)
      throw program::UsageError("--recorded-tool, --within and --partial need --script recording FILE");
    return;
  }
  if (options.recording.empty())
    throw program::UsageError("--script recording: which? --script recording FILE");
  if (options.depth || options.slide || options.clearance || options.pokes)
    throw program::UsageError(
        "--depth, --slide, --pokes and --clearance: a recording is played as it was recorded");
  if (!options.at.empty() || !options.beside.empty() || options.tip_radius)
    throw program::UsageError("--at, --beside and --tip-radius: a recording is played where it was recorded");
}

std::optional<std::uint32_t> asId(const std::optional<int>& tool) {
  return tool ? std::optional(static_cast<std::uint32_t>(*tool)) : std::nullopt;
}

// @return the program's exit code
int verdictOn(const PlayedBack& played) {
  if (played.playback.server_left) return program::kFailed;
  if (!played.within || played.holds()) return program::kDone;
  if (!played.isJudged()) {
    std::cerr << "palpate-tool: nothing is judged: "
              << (played.playback.isWhole() ? "no recorded force can be compared\n"
                                            : "the session was not played to its end on one organ\n");
    return program::kFailed;
  }
  std::cerr << "palpate-tool: forces differ by more than " << 100.0 * *played.within
            << " % of the largest, or the answers to less than half of the poses can be compared\n";
  return program::kNotHeld;
}

int playBack(const Options& options) {
  // 1. The recording, before anything waits.
  const RecordedSession session =
      readSession(options.recording, {asId(options.recorded_tool), options.seconds, options.partial});
  if (options.tool_id && std::count(session.has.begin(), session.has.end(), true) > 1)
    throw program::UsageError("--tool " + std::to_string(*options.tool_id) +
                              ": several tools were recorded; --recorded-tool chooses one");
  client::catchStopSignals();
  // 2. The server.
  const dds::Participant participant = client::join(options.domain, options.security, {dds::Role::kDriver});
  const client::ServerInfo server = client::findServer(participant, options.wait_s, options.wanted);
  std::cerr << notesOf(options.recording, session, asId(options.tool_id), server);
  // 3. Play, and tell.
  const Playback playback = playRecording(participant, session, asId(options.tool_id), runOf(server));
  if (!playback.realtime) std::cerr << client::kNotRealtime;
  const auto share = options.within ? std::optional(0.01 * *options.within) : std::nullopt;
  const PlayedBack played{options.recording, session, playback, server, share};
  (options.json ? std::cerr : std::cout) << tableOf(played) << std::flush;
  if (options.json) program::printJson(jsonOf(played));
  if (!options.plot.empty()) program::writeFile(options.plot, plotOf(played));
  return verdictOn(played);
}

int body(int argc, char** argv) {
  // 1. What to do; refuses bad values before it waits.
  program::CommandLine line("palpate-tool",
                            "Plays a scripted tool path, or a recorded session, against a palpate-server and "
                            "prints the force on the "
                            "tool.");
  Options options;
  addOptions(line.options(), options);
  if (!line.read(argc, argv)) return program::kDone;
  program::checkOutput("--plot", options.plot);
  checkRecordingOptions(options);
  if (options.playsRecording()) return playBack(options);
  if (!options.at.empty()) (void)program::parseVector("--at", options.at);
  if (!options.beside.empty()) (void)program::parseVector("--beside", options.beside);
  client::catchStopSignals();

  // 2. Find the server and its organ.
  const dds::Participant participant = client::join(options.domain, options.security, {dds::Role::kDriver});
  const client::ServerInfo server = client::findServer(participant, options.wait_s, options.wanted);

  const auto at = report::askedPlace(server.surface, "--at", options.at);
  const auto beside = report::askedPlace(server.surface, "--beside", options.beside);

  // 3. Play the path, and tell.
  std::ostream& out = options.json ? std::cerr : std::cout;
  const Played played = prepare(options, at, server);
  const Recording recording = play(participant, options.tool(), played.path, runOf(server));
  out << tableOf(played, recording) << std::flush;
  if (!beside || client::stopRequested() || recording.server_left) {
    if (options.json) program::printJson(jsonOf(played, recording));
    if (!options.plot.empty()) program::writeFile(options.plot, plotOf(played, recording));
    return verdictOn(recording, server.surface);
  }

  // 4. The same beside it.
  std::this_thread::sleep_for(kLetGo);
  const Played other = prepare(options, *beside, server);
  const Recording other_recording = play(participant, options.tool(), other.path, runOf(server));
  out << '\n' << tableOf(other, other_recording) << comparisonOf(recording, other_recording) << std::flush;
  if (options.json) {
    program::Json both = jsonOf(played, recording);
    both["beside"] = jsonOf(other, other_recording);
    program::printJson(both);
  }
  if (!options.plot.empty())
    program::writeFile(options.plot, plotOfBoth(played, recording, other, other_recording));
  return std::max(verdictOn(recording, server.surface), verdictOn(other_recording, server.surface));
}

}  // namespace
}  // namespace palpate::tool

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-tool", &palpate::tool::body, argc, argv);
}
