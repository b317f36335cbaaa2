// SPDX-License-Identifier: Apache-2.0
// palpate-list: servers, organs, tools and who drives them, on a DDS domain.
#include <chrono>
#include <filesystem>
#include <iostream>
#include <thread>

#include "list_report.h"
#include "palpate/client/error.h"
#include "palpate/client/joining.h"
#include "palpate/client/no_server.h"
#include "palpate/client/stop_signal.h"
#include "tools/program/command_line.h"
#include "tools/program/run.h"

namespace palpate::list {
namespace {

struct Options {
  std::uint32_t domain{0};
  std::filesystem::path security;
  double timeout_s{2.0};
  bool json{false};
};

void addOptions(program::Options line, Options& options) {
  line.add("--domain", &options.domain, "DDS domain").range(0, 230);
  line.add("--security", &options.security, client::kSecurityHelp).valueName("FOLDER");
  line.add("--timeout", &options.timeout_s,
           "how long to listen; a server says its status once a second, a latched one at once")
      .range(0.1, 600.0, "s");
  line.flag("--json", &options.json, "print one JSON object on standard output");
  line.example("palpate-list --domain 7 --timeout 3");
}

std::chrono::milliseconds millisecondsOf(double seconds) {
  return std::chrono::milliseconds(static_cast<long>(1e3 * seconds));
}

void listen(double seconds) {
  const auto end = std::chrono::steady_clock::now() + millisecondsOf(seconds);
  while (std::chrono::steady_clock::now() < end && !client::stopRequested())
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

int body(int argc, char** argv) {
  // 1. Where to listen.
  program::CommandLine line("palpate-list",
                            "Lists the servers, organs, tools and publishers of poses on a DDS domain.");
  Options options;
  addOptions(line.options(), options);
  if (!line.read(argc, argv)) return program::kDone;
  client::catchStopSignals();

  // 2. Listen.
  const dds::Participant participant = client::join(options.domain, options.security, client::kReaders);
  const Survey survey(participant);
  listen(options.timeout_s);

  // 3. Tell.
  constexpr double kForDevices = 1.0;  // s
  const Listing listing = survey.listing(kForDevices);
  if (options.json)
    program::printJson(jsonOf(listing));
  else
    std::cout << textOf(listing) << std::flush;
  if (!listing.servers.empty()) return program::kDone;
  if (client::stopRequested()) throw client::ClientError("interrupted");
  const std::string found = "no server" + client::where(options.domain, millisecondsOf(options.timeout_s));
  const std::string mismatch = survey.mismatch();
  throw client::ClientError(mismatch.empty() ? found + client::kNoServerHint : found + "; " + mismatch);
}

}  // namespace
}  // namespace palpate::list

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-list", &palpate::list::body, argc, argv);
}
