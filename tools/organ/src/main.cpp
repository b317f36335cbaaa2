// SPDX-License-Identifier: Apache-2.0
// palpate-organ makes and imports organ meshes. See README.md.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "palpate/mesh/box_mesh.h"
#include "palpate/mesh/topology.h"
#include "palpate/mesh/write_msh.h"
#include "palpate/organ/import_organ.h"
#include "palpate/organ/liver.h"
#include "report.h"

namespace {

using palpate::organ::ImportedOrgan;

struct Arguments {
  std::string output, input, fixed;
  double element_size{0};
  double scale{1};
  bool json{false};
};

void addOutput(CLI::App& command, Arguments& arguments) {
  command.add_option("-o,--output", arguments.output, "The .msh file to write (Gmsh 4.1)")->required();
  command.add_flag("--json", arguments.json, "Print one JSON object on standard output");
}

CLI::App* addLiver(CLI::App& app, Arguments& arguments) {
  CLI::App* command =
      app.add_subcommand("liver", "Make the default organ, a liver-like body of about 0.22 x 0.13 x 0.12 m");
  addOutput(*command, arguments);
  command->add_option("--element-size", arguments.element_size, "Edge length of the tetrahedra, m [0.0067]");
  return command;
}

CLI::App* addBeam(CLI::App& app, Arguments& arguments) {
  CLI::App* command = app.add_subcommand("beam", "Make the beam of 400 x 40 x 40 mm, clamped at x = 0");
  addOutput(*command, arguments);
  return command;
}

CLI::App* addImport(CLI::App& app, Arguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "import",
      "Import a mesh (.msh 1, 2, 4; .vtk; .mesh) or fill a closed surface (.stl, .obj). Nodes are numbered "
      "from 1 in the file's order.");
  command->add_option("file", arguments.input, "The mesh to import")->required();
  addOutput(*command, arguments);
  command->add_option("--scale", arguments.scale, "Metres per unit of the file [1]");
  command->add_option(
      "--fixed", arguments.fixed,
      "What is held: group:NAME, lowest-z:FRACTION of the surface nodes, or box:x0,y0,z0,x1,y1,z1 in m "
      "after scaling [the file's group 'fixed']");
  command->add_option("--element-size", arguments.element_size,
                      "Remesh a surface at this edge length, m [keep its triangles]");
  return command;
}

ImportedOrgan withBoundary(palpate::mesh::TetMesh mesh) {
  ImportedOrgan organ{std::move(mesh), {}, {}};
  organ.boundary = palpate::mesh::boundaryOf(organ.mesh);
  return organ;
}

ImportedOrgan importFile(const CLI::App& command, const Arguments& arguments) {
  palpate::organ::ImportOptions options;
  options.scale = arguments.scale;
  options.element_size = arguments.element_size;
  if (command.count("--fixed") > 0) options.fixed = palpate::organ::parseFixedRule(arguments.fixed);
  ImportedOrgan organ = palpate::organ::importOrgan(arguments.input, options);
  palpate::organ::renumber(organ.mesh);
  return organ;
}

void writeAndReport(const ImportedOrgan& organ, const Arguments& arguments) {
  palpate::mesh::writeMsh(arguments.output, organ.mesh, organ.boundary);
  const auto report = palpate::organ::makeReport(arguments.output, organ.mesh, organ.boundary, organ.notes);
  // Names come from files and may be no UTF-8; JSON must be.
  if (arguments.json) {
    const auto json = palpate::organ::toJson(report);
    std::cout << json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  }
  palpate::organ::print(arguments.json ? std::cerr : std::cout, report);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Makes and imports organ meshes: metres, linear tetrahedra, groups `fixed` and `accessible`."};
  app.set_version_flag("--version", PALPATE_VERSION);
  app.require_subcommand(1);
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return std::string("palpate-organ: ") + error.what() + " (--help tells more)\n";
  });
  Arguments arguments;
  const CLI::App* const liver = addLiver(app, arguments);
  const CLI::App* const beam = addBeam(app, arguments);
  const CLI::App* const importer = addImport(app, arguments);
  CLI11_PARSE(app, argc, argv);
  try {
    if (liver->parsed()) {
      const bool given = liver->count("--element-size") > 0;
      const double size = given ? arguments.element_size : palpate::organ::kLiverElementSize;
      writeAndReport(withBoundary(palpate::organ::makeLiver(size)), arguments);
    } else if (beam->parsed()) {
      writeAndReport(withBoundary(palpate::mesh::makeBeam()), arguments);
    } else {
      writeAndReport(importFile(*importer, arguments), arguments);
    }
  } catch (const std::exception& error) {
    std::cerr << "palpate-organ: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
