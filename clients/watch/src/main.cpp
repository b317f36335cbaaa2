// SPDX-License-Identifier: Apache-2.0
// palpate-watch: a viewer without a screen; follows the displacement of an organ's surface.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "field_log.h"
#include "next_surface.h"
#include "palpate/client/error.h"
#include "palpate/client/frame_pace.h"
#include "palpate/client/joining.h"
#include "palpate/client/server_finder.h"
#include "palpate/client/stop_signal.h"
#include "palpate/idl/printable.h"
#include "palpate/report/vtk_surface.h"
#include "palpate/rt/clock.h"
#include "palpate/rt/pacer.h"
#include "tools/program/command_line.h"
#include "tools/program/json.h"
#include "tools/program/printed.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"

namespace palpate::watch {
namespace {

struct Options {
  double seconds{10.0};
  std::uint32_t domain{0};
  std::filesystem::path security;
  client::WantedServer wanted;
  double wait_s{10.0};
  double rate_hz{0.0};
  bool json{false};
  std::string vtk;
};

// What the reader's callbacks work on.
struct Watch {
  FieldLog& log;
  std::optional<client::FramePace> pace;  // nothing: takes all fields
};

void addOptions(program::Options line, Options& options) {
  line.add("--seconds", &options.seconds, "how long to watch").range(0.1, 86400.0, "s");
  line.add("--rate", &options.rate_hz, "most fields per second to look at; 0: all of them")
      .range(0.0, 10000.0, "Hz");
  line.add("--domain", &options.domain, "DDS domain").range(0, 230);
  line.add("--security", &options.security, client::kSecurityHelp).valueName("FOLDER");
  line.add("--server-id", &options.wanted.server_id, "which server of the domain; default: the first found")
      .range(std::int64_t{0}, client::kMaxServerId);
  line.add("--organ-id", &options.wanted.organ_id, client::kOrganIdHelp)
      .range(std::int64_t{0}, client::kMaxOrganId);
  line.add("--wait", &options.wait_s, "how long to wait for a server").range(0.0, 3600.0, "s");
  line.add("--vtk", &options.vtk, "write the surface at its largest displacement to this .vtu or .vtk file");
  line.flag("--json", &options.json, "print one JSON object on standard output");
  line.example("palpate-watch --seconds 5 --vtk deformed.vtu");
}

void printLine(std::ostream& out, double t, double rate, const client::Surface& surface,
               const NodeDisplacement& largest) {
  const device::Point& X = surface.positions[largest.node];
  out << program::printed("%7.1f s  %7.1f fields/s  largest %8.4f mm at node %lld (%.4f, %.4f, %.4f) m\n", t,
                          rate, largest.size * 1e3, static_cast<long long>(surface.mesh_tags[largest.node]),
                          X[0], X[1], X[2])
      << std::flush;
}

// The server has taken another model: its organ is followed from here on.
void goOver(std::shared_ptr<const client::Surface> next, FieldLog& log) {
  std::cerr << "the server took another model, " << dds::printable(next->model_id.c_str()) << ": "
            << next->positions.size() << " nodes\n";
  log.change(std::move(next));
}

// Prints a line a second until the time is over or the user stops. @return seconds watched
double follow(FieldLog& log, NextSurface& next, double seconds, std::ostream& out) {
  const std::int64_t start_ns = rt::monotonicNow();
  const auto elapsed = [&] { return static_cast<double>(rt::monotonicNow() - start_ns) * 1e-9; };
  rt::Pacer pacer(50'000'000);
  double last_s = 0.0;
  std::uint64_t last_count = 0;
  while (elapsed() < seconds && !client::stopRequested()) {
    pacer.wait();
    if (auto surface = next.take()) goOver(std::move(surface), log);
    const double now_s = elapsed();
    if (now_s - last_s < std::min(1.0, seconds)) continue;
    const FieldSummary summary = log.summary();
    printLine(out, now_s, static_cast<double>(summary.received - last_count) / (now_s - last_s),
              *summary.surface, summary.largest);
    last_s = now_s;
    last_count = summary.received;
  }
  return elapsed();
}

program::Json jsonOf(const FieldSummary& summary, double seconds) {
  const client::Surface& surface = *summary.surface;
  const auto node = [&](const NodeDisplacement& at) -> program::Json {
    return {{"size", at.size},
            {"displacement", at.u},
            {"node", surface.mesh_tags[at.node]},
            {"position", surface.positions[at.node]}};
  };
  return {
      {"model_id", surface.model_id},          {"surface_nodes", surface.positions.size()},
      {"triangles", surface.triangles.size()}, {"seconds", seconds},
      {"received", summary.received},          {"rate_hz", static_cast<double>(summary.received) / seconds},
      {"superseded", summary.superseded},      {"refused", summary.refused},
      {"left_out", summary.left_out},          {"model_changes", summary.model_changes},
      {"last", node(summary.largest)},         {"peak", node(summary.peak)}};
}

int body(int argc, char** argv) {
  // 1. What to do.
  program::CommandLine line("palpate-watch",
                            "Follows the displacement of the organ that a palpate-server simulates.");
  Options options;
  addOptions(line.options(), options);
  if (!line.read(argc, argv)) return program::kDone;
  if (!options.vtk.empty()) program::orUsageError([&] { report::checkSurfacePath(options.vtk); }, "--vtk: ");
  program::checkOutput("--vtk", options.vtk);
  client::catchStopSignals();

  // 2. Find the server and its organ.
  const dds::Participant participant = client::join(options.domain, options.security, client::kReaders);
  const auto surface = std::make_shared<const client::Surface>(
      client::findServer(participant, options.wait_s, options.wanted).surface);

  // 3. Follow the field.
  NextSurface next(participant, *surface);
  FieldLog log(surface);
  Watch watch{log, {}};
  if (options.rate_hz > 0.0) watch.pace.emplace(options.rate_hz);
  const auto on_data = [](dds::ReaderView<dds::SurfaceDisplacement> reader, void* context) noexcept {
    static_cast<Watch*>(context)->log.take(reader);
  };
  // Fields of other servers use up none of the rate.
  const auto admits = [](const dds::SurfaceDisplacement& field, void* context) noexcept {
    auto& self = *static_cast<Watch*>(context);
    return !self.pace || !self.log.holds(field.session) || self.pace->admits(rt::monotonicNow());
  };
  const dds::Reader<dds::SurfaceDisplacement> reader(participant, on_data, &watch, admits);
  const double seconds = follow(log, next, options.seconds, options.json ? std::cerr : std::cout);

  // 4. Tell.
  const FieldSummary summary = log.summary();
  if (options.json) program::printJson(jsonOf(summary, seconds));
  if (!options.vtk.empty()) report::writeSurface(options.vtk, *summary.surface, log.peakField());
  if (summary.received == 0)
    throw client::ClientError("no displacement field came within " + std::to_string(seconds) + " s");
  return 0;
}

}  // namespace
}  // namespace palpate::watch

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-watch", &palpate::watch::body, argc, argv);
}
