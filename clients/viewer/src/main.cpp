// SPDX-License-Identifier: Apache-2.0
// palpate-viewer: shows an organ in browsers and lets them touch it.
#include <malloc.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>

#include "export_page.h"
#include "palpate/client/error.h"
#include "palpate/client/joining.h"
#include "palpate/client/stop_signal.h"
#include "palpate/idl/receive_threads.h"
#include "palpate/rt/scheduling.h"
#include "tools/program/command_line.h"
#include "tools/program/installed.h"
#include "tools/program/json.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"
#include "web_server.h"

namespace palpate::viewer {
namespace {

constexpr int kReceivePriority = 35;  // below the server's threads

struct Options {
  WebOptions web;
  std::string page;
  std::optional<std::string> export_folder;
  std::string model;
  std::string token_file;
  std::uint32_t domain{0};
  std::filesystem::path security;
  client::WantedServer wanted;
  std::vector<std::uint32_t> tools{3, 2, 1, 0};  // a device's usual tool, 0, last
  bool json{false};
};

void addOptions(program::Options line, Options& options) {
  WebOptions& web = options.web;
  line.add("--domain", &options.domain, "DDS domain").range(0, 230);
  line.add("--security", &options.security, client::kSecurityHelp).valueName("FOLDER");
  line.add("--server-id", &options.wanted.server_id, "which server of the domain; default: the first found")
      .range(std::int64_t{0}, client::kMaxServerId);
  line.add("--organ-id", &options.wanted.organ_id, client::kOrganIdHelp)
      .range(std::int64_t{0}, client::kMaxOrganId);
  line.add("--listen", &web.access.listen,
           "numeric address to listen on; one that other machines reach needs a token");
  line.add("--port", &web.access.port, "TCP port; 0: any that is free");
  line.add("--page", &options.page,
           "folder with the page's index.html; default: " + program::installedText(PALPATE_PAGE_FROM_BIN));
  line.add(
      "--export", &options.export_folder,
      "write the page into this new or empty folder, with an organ of its own, for any web server; then end");
  line.add("--model", &options.model,
           "with --export: model file that the page opens; without it the page asks for one");
  line.add("--token-file", &options.token_file,
           "file whose first line is the secret that lets people in: 16 to 128 letters, digits, - and _");
  line.add("--tls-cert", &web.tls.certificate, "PEM file with the certificate of this machine, for https");
  line.add("--tls-key", &web.tls.key, "PEM file with the certificate's key");
  line.add(
      "--origin", &web.access.origins,
      "further address under which browsers see the page, e.g. https://viewer.example.org; may be repeated");
  line.add("--rate", &web.rate_hz, "frames a second to each page, at most").range(1.0, 1000.0, "Hz");
  line.add("--max-pages", &web.max_pages, "pages that may be open at once").range(1, 256);
  line.add("--tools", &options.tools, "tool ids that pages may drive, in the order of preference")
      .list(',')
      .range(0, 3);
  line.flag("--json", &options.json,
            "when it listens or has exported, print one JSON object on standard output");
  line.example("palpate-viewer --port 8080");
}

std::string tokenFrom(const std::string& path) {
  std::ifstream file(path);
  std::string token;
  if (!std::getline(file, token)) throw program::UsageError("--token-file: cannot read a token from " + path);
  return token;
}

void announce(const WebServer& server, const Options& options) {
  const bool token = !options.web.access.token.empty();
  if (options.json) {
    program::printJson({{"address", server.address()},
                        {"login_address", server.loginAddress()},
                        {"port", server.port()},
                        {"domain", options.domain},
                        {"needs_token", token},
                        {"tls", options.web.tls.given()}});
  } else {
    std::cout << "page at " << server.loginAddress()
              << (token ? " (lets one browser in, within 10 minutes; others give the token)" : "")
              << std::endl;
  }
}

void writePage(const Options& options) {
  const Exported written = exportPage(options.web.page, *options.export_folder, options.model);
  if (options.json) {
    program::printJson({{"folder", *options.export_folder},
                        {"model", options.model},
                        {"files", written.files},
                        {"bytes", written.bytes}});
  } else {
    std::cout << *options.export_folder << ": " << written.files << " files, " << written.bytes / 1000
              << " kB, for any web server\n";
  }
}

void warnOfOpenDoors(const WebOptions& web) {
  if (!isLoopback(web.access.listen) && !web.tls.given())
    spdlog::warn(
        "--listen {} without TLS: anyone on the way reads the token and all that pages see. Give --tls-cert "
        "and "
        "--tls-key, or listen on 127.0.0.1 behind a proxy (clients/viewer/ACCESS.md)",
        web.access.listen);
}

// A viewer runs for weeks, while others come and go: one heap, and buffers of DDS (1 MiB each) mapped apart, give more
// back than a heap for each thread. The price: the thread that sends a page's poses may wait for others at the heap's
// lock. These come by a browser, which is less punctual than that.
void keepMemoryTogether() {
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, 512 * 1024);
}

int body(int argc, char** argv) {
  keepMemoryTogether();
  // 1. What to do.
  program::CommandLine line(
      "palpate-viewer",
      "Shows the organ that a palpate-server simulates in browsers, and lets them touch it.");
  Options options;
  addOptions(line.options(), options);
  if (!line.read(argc, argv)) return program::kDone;
  if (!options.export_folder && !options.model.empty())
    throw program::UsageError("--model is for --export: a server has its own model");
  options.web.page = options.page.empty() ? defaultPageFolder() : std::filesystem::path(options.page);
  if (options.export_folder) {
    program::checkOutputFolder("--export", *options.export_folder);
    program::orUsageError([&] { checkFolders(options.web.page, *options.export_folder); });
    writePage(options);
    return 0;
  }
  if (!options.token_file.empty()) options.web.access.token = tokenFrom(options.token_file);
  program::orUsageError([&] { check(options.web); });
  spdlog::set_default_logger(spdlog::stderr_color_mt("palpate-viewer"));
  client::catchStopSignals();
  std::signal(SIGPIPE, SIG_IGN);

  warnOfOpenDoors(options.web);

  // 2. Listen, and join the domain.
  WebServer server(options.web);
  const dds::Participant participant = client::join(options.domain, options.security, client::kReaders);
  Viewer viewer(participant, options.wanted, options.web.rate_hz, options.tools, &WebServer::wake, &server);
  // Where the kernel grants it: browsers keep a machine busy.
  (void)rt::raiseThreadsNamed(dds::kReceiveThreads, kReceivePriority);

  // 3. Serve.
  announce(server, options);
  server.run(viewer);
  return 0;
}

}  // namespace
}  // namespace palpate::viewer

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-viewer", &palpate::viewer::body, argc, argv);
}
