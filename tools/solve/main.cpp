// SPDX-License-Identifier: Apache-2.0
// palpate-solve: a mesh and a case become a model file.
//
// Sample runs:  palpate-solve liver.msh -o liver.h5
//               palpate-solve case.toml -o liver.h5 --json
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "palpate/mesh/checks.h"
#include "palpate/mesh/mesh_error.h"
#include "palpate/mesh/read_mesh.h"
#include "palpate/modelfile/model_file.h"
#include "palpate/offline/build_model.h"
#include "palpate/offline/parallel.h"
#include "provenance.h"

namespace {

using namespace palpate;
using Clock = std::chrono::steady_clock;

struct Options {
  std::filesystem::path input;
  std::filesystem::path output{"model.h5"};
  std::filesystem::path scratch;
  int threads{offline::machineThreads()};
  bool json{false};
  bool quiet{false};
};

void describe(CLI::App& app, Options& options) {
  app.add_option("input", options.input,
                 "case file (.toml), or a mesh in metres to be solved with the defaults")
      ->required();
  app.add_option("-o,--output", options.output, "model file to write")->capture_default_str();
  app.add_option("--scratch", options.scratch, "folder of the scratch file (default: beside the output)");
  app.add_option("--threads", options.threads, "worker threads")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_flag("--json", options.json, "print one JSON object on standard output");
  app.add_flag("-q,--quiet", options.quiet, "no progress");
}

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double peakMemoryMiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

offline::Case readInput(const Options& options) {
  return options.input.extension() == ".toml" ? offline::readCase(options.input)
                                              : offline::defaultCase(options.input);
}

/// A bare mesh that names its accessible group means it.
void adoptGroups(offline::Case& c, const mesh::TetMesh& organ) {
  if (c.text.empty() && organ.groups.count("accessible") != 0) c.accessible = "accessible";
}

/// What can be said of the output before minutes are spent on it.
void checkOutput(const std::filesystem::path& output) {
  const std::filesystem::path folder = std::filesystem::absolute(output).parent_path();
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error("--output " + output.string() + ": " + why);
  };
  if (output.extension() == ".xdmf") refuse("an .xdmf is written beside the model; name the model .h5");
  if (std::filesystem::is_directory(output)) refuse("is a folder");
  if (!std::filesystem::is_directory(folder)) refuse("there is no folder " + folder.string());
  if (access(folder.c_str(), W_OK) != 0) refuse("the folder " + folder.string() + " cannot be written");
}

mesh::TetMesh readOrgan(const std::filesystem::path& path, const std::string& fixed) {
  mesh::TetMesh organ = mesh::readMesh(path);
  try {
    mesh::checkMesh(organ);
    if (organ.groups.count(fixed) != 0) mesh::checkHeld(organ, fixed);
  } catch (const mesh::MeshError& error) {
    throw mesh::MeshError(path.string() + ": " + error.what());
  }
  return organ;
}

nlohmann::json summary(const Options& options, const modelfile::ModelData& data,
                       const offline::BuildReport& report, double total_seconds, double write_seconds) {
  std::vector<double> radii;  // of what a tool may touch, helpers left out
  for (std::size_t i = 0; i < data.contact_domain_radius.size(); ++i)
    if (data.contact_accessible[i] != 0) radii.push_back(data.contact_domain_radius[i]);
  std::sort(radii.begin(), radii.end());
  const auto quantile = [&](double q) {
    return radii[static_cast<std::size_t>(q * static_cast<double>(radii.size() - 1) + 0.5)];
  };
  return {{"model", options.output.string()},
          {"nodes", data.mesh_node_tag.size()},
          {"tetrahedra", data.mesh_tetrahedron_tag.size()},
          {"surface_nodes", data.surface_mesh_tag.size()},
          {"contact_positions", data.contact_node.size()},
          {"patch_radius", data.attributes.patch_radius},
          {"order", data.attributes.order},
          {"modes", data.modes_X.size() / (3 * data.surface_mesh_tag.size())},
          {"domain_radius", {{"min", radii.front()}, {"p05", quantile(0.05)}, {"median", quantile(0.5)}}},
          {"fit_error", report.fit_errors.back()},
          {"seconds",
           {{"factor", report.factor_seconds},
            {"series", report.series_seconds},
            {"fit", report.fit_seconds},
            {"write", write_seconds},
            {"total", total_seconds}}},
          {"file_bytes", std::filesystem::file_size(options.output)},
          {"peak_memory_MiB", peakMemoryMiB()}};
}

void print(const nlohmann::json& s) {
  const auto& t = s["seconds"];
  std::fprintf(stderr,
               "%zu nodes, %zu tetrahedra, %zu surface nodes; %zu contact positions, patch radius %.2f mm, "
               "order %d, %zu modes\n"
               "time: factor %.1f s, series %.1f s, fit %.1f s, writing %.1f s, together %.1f s\n"
               "domain radius: 5 %% quantile %.2f mm, median %.2f mm; RMS error of the fit %.2f %%\n"
               "model: %s, %.1f MB; peak memory %.0f MiB\n",
               s["nodes"].get<std::size_t>(), s["tetrahedra"].get<std::size_t>(),
               s["surface_nodes"].get<std::size_t>(), s["contact_positions"].get<std::size_t>(),
               1e3 * s["patch_radius"].get<double>(), s["order"].get<int>(), s["modes"].get<std::size_t>(),
               t["factor"].get<double>(), t["series"].get<double>(), t["fit"].get<double>(),
               t["write"].get<double>(), t["total"].get<double>(),
               1e3 * s["domain_radius"]["p05"].get<double>(),
               1e3 * s["domain_radius"]["median"].get<double>(), 100.0 * s["fit_error"].get<double>(),
               s["model"].get<std::string>().c_str(), 1e-6 * s["file_bytes"].get<double>(),
               s["peak_memory_MiB"].get<double>());
}

void run(Options options) {
  const auto start = Clock::now();
  // 1. What to solve, and where to.
  checkOutput(options.output);
  offline::Case c = readInput(options);
  // 2. The organ.
  const mesh::TetMesh organ = readOrgan(c.mesh, c.fixed);
  adoptGroups(c, organ);
  // 3. Series, far field, near field.
  if (options.scratch.empty()) options.scratch = std::filesystem::absolute(options.output).parent_path();
  offline::BuildReport report;
  modelfile::ModelData data =
      offline::buildModel(c, organ, {options.threads, options.scratch, options.quiet}, report);
  // 4. Where it came from, and the file.
  solve::addProvenance(data, c, report);
  const auto write_start = Clock::now();
  modelfile::writeModel(options.output, data);
  modelfile::writeXdmf(options.output);
  // 5. What came out.
  const nlohmann::json s = summary(options, data, report, secondsSince(start), secondsSince(write_start));
  print(s);
  if (options.json) std::cout << s.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Computes the meta-model of an organ: its answer to a tool at any position and in any direction."};
  app.set_version_flag("--version", PALPATE_VERSION);
  Options options;
  describe(app, options);
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return "palpate-solve: " + std::string(error.what()) + " (see palpate-solve --help)\n";
  });
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::bad_alloc&) {
    std::cerr
        << "palpate-solve: out of memory; fewer modes, a smaller near_radius or a lower order need less\n";
    return 1;
  } catch (const std::exception& error) {
    std::cerr << "palpate-solve: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
