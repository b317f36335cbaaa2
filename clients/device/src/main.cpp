// SPDX-License-Identifier: Apache-2.0
// palpate-device: a simulated haptic device in a hand touches the organ, driven by the server's forces.
#include <array>
#include <iostream>
#include <optional>

#include "core/devices/path/path.h"
#include "core/devices/sim/closed_loop.h"
#include "device_report.h"
#include "palpate/client/error.h"
#include "palpate/client/stop_signal.h"
#include "tools/program/command_line.h"
#include "tools/program/json.h"
#include "tools/program/numbers.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"

namespace palpate::device {
namespace {

struct Arguments {
  std::string preset{"touch"};
  std::optional<double> mass, damping, friction;
  std::string hand{"0.1,2,200"};
  std::string motion{"press"};
  MotionOptions path;
  std::string at;
  std::uint32_t tool_id{0};
  std::uint32_t domain{0};
  std::uint32_t server_id{dds::kServerAny};
  double wait_s{10.0};
  bool json{false};
  std::string plot;
};

void addDevice(program::Options line, Arguments& arguments) {
  line.add("--preset", &arguments.preset, "the device: touch, omni, desktop, premium15, premium30 or custom")
      .oneOf({"touch", "omni", "desktop", "premium15", "premium30", "custom"});
  line.add("--mass", &arguments.mass, "moving mass of the device, kg; default: the preset's, custom 0.1");
  line.add("--damping", &arguments.damping, "its damping, N s/m; default: the preset's, custom 0");
  line.add("--friction", &arguments.friction, "its Coulomb friction, N; default: the preset's, custom 0");
  line.add("--hand", &arguments.hand, "mass (kg), damping (N s/m), stiffness (N/m) of the hand: M,B,K");
}

void addOptions(program::Options line, Arguments& arguments) {
  addDevice(line, arguments);
  line.add("--motion", &arguments.motion, "what the hand does: press, drag or tap")
      .oneOf({"press", "drag", "tap"});
  line.add("--seconds", &arguments.path.seconds, "duration of the whole, s");
  line.add("--depth", &arguments.path.depth, "wanted depth of the tip below the rest surface, m");
  line.add("--at", &arguments.at, "touch the accessible node nearest to x,y,z (m); default: the highest one");
  line.add("--tool", &arguments.tool_id, "tool id, 0 to 3").range(0, 3);
  line.add("--domain", &arguments.domain, "DDS domain").range(0, 230);
  line.add("--server-id", &arguments.server_id, "which server of the domain; default: the first found");
  line.add("--wait", &arguments.wait_s, "how long to wait for a server, s").range(0.0, 3600.0);
  line.flag("--json", &arguments.json, "print one JSON object on standard output");
  line.add("--plot", &arguments.plot, "write the depth over time to this SVG file");
}

Mechanics mechanicsOf(const Arguments& arguments) {
  Mechanics mechanics{0.1, 0.0, 0.0};  // custom's
  if (const auto preset = findDevicePreset(arguments.preset)) mechanics = device::mechanicsOf(*preset);
  mechanics.mass = arguments.mass.value_or(mechanics.mass);
  mechanics.damping = arguments.damping.value_or(mechanics.damping);
  mechanics.friction = arguments.friction.value_or(mechanics.friction);
  check(mechanics);
  return mechanics;
}

Hand handOf(const Arguments& arguments) {
  const std::array<double, 3> values = program::parseVector("--hand", arguments.hand);
  const Hand hand{values[0], values[1], values[2]};
  check(hand);
  return hand;
}

client::Spot spotOf(const Arguments& arguments, const client::Surface& surface) {
  std::optional<Point> at;
  if (!arguments.at.empty()) at = Point{program::parseVector("--at", arguments.at)};
  return client::chooseSpot(surface, at);
}

Session play(const dds::Participant& participant, const Arguments& arguments, const Mechanics& mechanics,
             const Hand& hand, const client::ServerInfo& server) {
  if (arguments.preset != server.status.device)
    std::cerr << "note: the server is set for device '" << server.status.device << "', this is '"
              << arguments.preset << "'\n";
  const client::Spot spot = spotOf(arguments, server.surface);
  const Motion motion = makeMotion(arguments.motion, spot.position, spot.normal, arguments.path);
  HeldDevice device(mechanics, hand, motion.path);
  const Trace without = withoutOrgan(device, motion);
  const Recording recording = run(participant, arguments.tool_id, device, runOf(server));
  return {arguments.preset,
          mechanics,
          hand,
          arguments.motion,
          motion,
          spot,
          server,
          recording,
          without,
          judge(recording.trace, without, motion)};
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
  if (!line.read(argc, argv)) return 0;
  const Mechanics mechanics = mechanicsOf(arguments);
  const Hand hand = handOf(arguments);
  if (!arguments.at.empty()) (void)program::parseVector("--at", arguments.at);
  arguments.path.lead = leadOf(mechanics, hand);
  (void)makeMotion(arguments.motion, {}, {0, 0, 1}, arguments.path);
  client::catchStopSignals();

  // 2. Find the server and its organ.
  const dds::Participant participant(arguments.domain);
  const client::ServerInfo server = client::findServer(participant, arguments.wait_s, arguments.server_id);

  // 3. The motion there, once without the organ and once against the server.
  arguments.path.tip_radius = server.status.tip_radius[arguments.tool_id];
  const Session session = play(participant, arguments, mechanics, hand, server);

  // 4. Tell.
  tell(session, arguments);
  return 0;
}

}  // namespace
}  // namespace palpate::device

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-device", &palpate::device::body, argc, argv);
}
