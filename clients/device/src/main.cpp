// SPDX-License-Identifier: Apache-2.0
// palpate-device: a simulated haptic device in a hand touches the organ, driven by the server's forces.
#include <array>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <optional>

#include "core/devices/path/path.h"
#include "core/devices/sim/closed_loop.h"
#include "core/devices/sim/delays.h"
#include "device_report.h"
#include "palpate/client/error.h"
#include "palpate/client/joining.h"
#include "palpate/client/parameter_exchange.h"
#include "palpate/client/place.h"
#include "palpate/client/stop_signal.h"
#include "palpate/idl/printable.h"
#include "palpate/report/asked_place.h"
#include "tools/program/command_line.h"
#include "tools/program/json.h"
#include "tools/program/numbers.h"
#include "tools/program/printed.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"

namespace palpate::device {
namespace {

struct Arguments {
  std::string preset{"touch"};
  std::optional<double> mass, damping, friction;
  std::string hand;
  std::string motion{"press"};
  MotionOptions path;
  std::string delay_from;
  std::string at;
  std::uint32_t tool_id{0};
  std::uint32_t domain{0};
  std::filesystem::path security;
  client::WantedServer wanted;
  double wait_s{10.0};
  bool json{false};
  std::string plot;
};

void addDevice(program::Options line, Arguments& arguments) {
  line.add("--preset", &arguments.preset, "the device: touch, omni, desktop, premium15, premium30 or custom")
      .oneOf({"touch", "omni", "desktop", "premium15", "premium30", "custom"});
  line.add("--mass", &arguments.mass, "moving mass of the device; default: the preset's, custom 0.1")
      .range(0.001, 10.0, "kg");
  line.add("--damping", &arguments.damping, "its viscous damping; default: the preset's, custom 0")
      .range(0.0, 100.0, "N s/m");
  line.add("--friction", &arguments.friction,
           "its Coulomb friction; default: the preset's, custom 0; with --delay-from 0")
      .range(0.0, 10.0, "N");
  line.add(
      "--hand", &arguments.hand,
      "mass (kg), damping (N s/m), stiffness (N/m) of the hand: M,B,K; default: 0.1,2,200; with --delay-from "
      "0.02,0.5,50, the loosest");
}

void addOptions(program::Options line, Arguments& arguments) {
  addDevice(line, arguments);
  line.add("--motion", &arguments.motion, "what the hand does: press, drag or tap")
      .oneOf({"press", "drag", "tap"});
  line.add("--seconds", &arguments.path.seconds, "duration of the whole; the least depends on the motion")
      .range(0.0, 3600.0, "s");
  line.add("--depth", &arguments.path.depth, "wanted depth of the tip below the rest surface")
      .range(1e-6, 0.05, "m");
  line.add("--at", &arguments.at,
           "touch the accessible node nearest to x,y,z, m; refused off the organ; default: the highest one");
  line.add("--delay-from", &arguments.delay_from,
           "delay, lose and reorder the answers as palpate-latency --samples measured it, where it was worst")
      .valueName("FILE");
  line.add("--tool", &arguments.tool_id, "tool id, 0 to 3").range(0, 3);
  line.add("--domain", &arguments.domain, "DDS domain").range(0, 230);
  line.add("--security", &arguments.security, client::kSecurityHelp).valueName("FOLDER");
  line.add("--server-id", &arguments.wanted.server_id, "which server of the domain; default: the first found")
      .range(std::int64_t{0}, client::kMaxServerId);
  line.add("--organ-id", &arguments.wanted.organ_id, client::kOrganIdHelp)
      .range(std::int64_t{0}, client::kMaxOrganId);
  line.add("--wait", &arguments.wait_s, "how long to wait for a server").range(0.0, 3600.0, "s");
  line.flag("--json", &arguments.json, "print one JSON object on standard output");
  line.add("--plot", &arguments.plot, "write the depth over time to this SVG file");
  line.example(
      "palpate-device --preset touch --hand 0.1,2,200 --motion tap --plot tap.svg\n"
      "         palpate-device --preset touch --delay-from delays.csv");
}

Mechanics mechanicsOf(const Arguments& arguments) {
  Mechanics mechanics{0.1, 0.0, 0.0};  // custom's
  if (const auto preset = findDevicePreset(arguments.preset)) mechanics = device::mechanicsOf(*preset);
  mechanics.mass = arguments.mass.value_or(mechanics.mass);
  mechanics.damping = arguments.damping.value_or(mechanics.damping);
  if (!arguments.delay_from.empty()) mechanics.friction = 0.0;  // it hides what rings
  mechanics.friction = arguments.friction.value_or(mechanics.friction);
  program::orUsageError([&] { check(mechanics); });
  return mechanics;
}

Hand handOf(const Arguments& arguments) {
  if (arguments.hand.empty()) return arguments.delay_from.empty() ? Hand{} : kLoosestHand;
  const std::array<double, 3> values = program::parseVector("--hand", arguments.hand);
  const Hand hand{values[0], values[1], values[2]};
  program::orUsageError([&] { check(hand); }, "--hand: ");
  return hand;
}

client::Spot spotOf(const Arguments& arguments, const client::Surface& surface) {
  return client::chooseSpot(surface, report::askedPlace(surface, "--at", arguments.at));
}

// A status names tool 0's device only. Nothing when the server does not say it.
std::string deviceOf(const dds::Participant& participant, std::uint32_t tool_id,
                     const client::ServerInfo& server) {
  if (tool_id == 0) return dds::printable(server.status.device);
  dds::ParameterRequest question{};
  question.server_id = server.status.server_id;
  question.session = server.status.session;
  question.tool_id = dds::kAllTools;
  try {
    const auto answer = client::exchangeParameters(participant, question, std::chrono::seconds(2));
    return dds::printable(answer.tools[tool_id].device);
  } catch (const client::ClientError&) {
    return {};
  }
}

void noteOtherDevice(const dds::Participant& participant, const Arguments& arguments,
                     const client::ServerInfo& server) {
  const std::string device = deviceOf(participant, arguments.tool_id, server);
  if (device == arguments.preset) return;
  std::cerr << "note: the server ";
  if (device.empty())
    std::cerr << "does not say for which device tool " << arguments.tool_id << " is set";
  else
    std::cerr << "is set for device '" << device << "' at tool " << arguments.tool_id;
  std::cerr << ", this is '" << arguments.preset << "'\n";
}

Session play(const dds::Participant& participant, const Arguments& arguments, const Mechanics& mechanics,
             const Hand& hand, const client::ServerInfo& server, const Delays* delays) {
  noteOtherDevice(participant, arguments, server);
  const client::Spot spot = spotOf(arguments, server.surface);
  const Motion motion = makeMotion(arguments.motion, spot.position, spot.normal, arguments.path);
  HeldDevice device(mechanics, hand, motion.path);
  const Trace without = withoutOrgan(device, motion);
  const Recording recording = run(participant, arguments.tool_id, device, runOf(server), delays);
  return {arguments.preset,
          mechanics,
          hand,
          arguments.motion,
          motion,
          spot,
          server,
          recording,
          without,
          judge(recording.trace, without, motion),
          judgeEnergy(recording.trace),
          arguments.delay_from,
          delays};
}

// Refuses bad values before anything waits.
void checkMotion(const Arguments& arguments) {
  if (arguments.path.lead > kLongestLead)
    throw program::UsageError(
        program::printed("--friction by the stiffness of --hand is %g m, by which the hand would lead the "
                         "device, expected at most %g m",
                         arguments.path.lead, kLongestLead));
  program::orUsageError([&] { (void)makeMotion(arguments.motion, {}, {0, 0, 1}, arguments.path); }, "--");
}

void tell(const Session& session, const Arguments& arguments) {
  (arguments.json ? std::cerr : std::cout) << textOf(session) << std::flush;
  if (arguments.json) program::printJson(jsonOf(session));
  if (!arguments.plot.empty()) program::writeFile(arguments.plot, plotOf(session));
}

int body(int argc, char** argv) {
  // 1. What to do; refuses bad values before it waits.
  program::CommandLine line(
      "palpate-device",
      "Moves a simulated haptic device, held by a hand, against a palpate-server and judges its stability.");
  Arguments arguments;
  addOptions(line.options(), arguments);
  if (!line.read(argc, argv)) return program::kDone;
  program::checkOutput("--plot", arguments.plot);
  const Mechanics mechanics = mechanicsOf(arguments);
  const Hand hand = handOf(arguments);
  if (!arguments.at.empty()) (void)program::parseVector("--at", arguments.at);
  arguments.path.lead = leadOf(mechanics, hand);
  checkMotion(arguments);
  std::optional<Delays> delays;
  if (!arguments.delay_from.empty()) delays = Delays::read(arguments.delay_from);
  if (delays) std::cerr << delays->note();
  client::catchStopSignals();

  // 2. Find the server and its organ.
  const dds::Participant participant =
      client::join(arguments.domain, arguments.security, {dds::Role::kDriver});
  const client::ServerInfo server = client::findServer(participant, arguments.wait_s, arguments.wanted);

  // 3. The motion there, once without the organ and once against the server.
  arguments.path.tip_radius = server.status.tip_radius[arguments.tool_id];
  const Session session = play(participant, arguments, mechanics, hand, server, delays ? &*delays : nullptr);

  // 4. Tell.
  tell(session, arguments);
  if (!session.complete()) return program::kFailed;
  if (!session.touched()) {
    const double nearest = client::nearestOf(server.surface, session.recording.trace.position,
                                             [](const Point& position) { return position; });
    std::cerr << "palpate-device: " << report::neverTouchedText(nearest) << '\n';
    return program::kFailed;
  }
  if (!session.judged()) {
    std::cerr << "palpate-device: the machine stood still too often: not judged, try again\n";
    return program::kFailed;
  }
  return session.stable() ? program::kDone : program::kNotHeld;
}

}  // namespace
}  // namespace palpate::device

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-device", &palpate::device::body, argc, argv);
}
