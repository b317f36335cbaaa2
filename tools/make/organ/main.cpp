// SPDX-License-Identifier: Apache-2.0
// palpate-organ makes and imports organ meshes. See README.md.
#include <iostream>
#include <optional>
#include <string>

#include "tools/make/organ/import_organ.h"
#include "tools/make/organ/liver.h"
#include "tools/make/organ/report.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/topology.h"
#include "tools/mesh/write_msh.h"
#include "tools/program/command_line.h"
#include "tools/program/run.h"

namespace palpate::organ {
namespace {

struct Arguments {
  std::string output, input;
  std::optional<std::string> fixed;
  std::optional<double> element_size;
  double scale{1};
  bool json{false};
};

void addOutput(program::Options& command, Arguments& arguments) {
  command.add("-o,--output", &arguments.output, "The .msh file to write (Gmsh 4.1)").required();
  command.flag("--json", &arguments.json, "Print one JSON object on standard output");
}

program::Options addLiver(program::Options line, Arguments& arguments) {
  program::Options command =
      line.subcommand("liver", "Make the default organ, a liver-like body of about 0.22 x 0.13 x 0.12 m");
  addOutput(command, arguments);
  command.add("--element-size", &arguments.element_size, "Edge length of the tetrahedra, m [0.0067]");
  return command;
}

program::Options addBeam(program::Options line, Arguments& arguments) {
  program::Options command = line.subcommand("beam", "Make the beam of 400 x 40 x 40 mm, clamped at x = 0");
  addOutput(command, arguments);
  return command;
}

void addImport(program::Options line, Arguments& arguments) {
  program::Options command = line.subcommand(
      "import",
      "Import a mesh (.msh 1, 2, 4; .vtk; .mesh) or fill a closed surface (.stl, .obj). Nodes are numbered "
      "from 1 in the file's order.");
  command.add("file", &arguments.input, "The mesh to import").required();
  addOutput(command, arguments);
  command.add("--scale", &arguments.scale, "Metres per unit of the file");
  command.add(
      "--fixed", &arguments.fixed,
      "What is held: group:NAME, lowest-z:FRACTION of the surface nodes, or box:x0,y0,z0,x1,y1,z1 in m "
      "after scaling [the file's group 'fixed']");
  command.add("--element-size", &arguments.element_size,
              "Remesh a surface at this edge length, m [keep its triangles]");
}

ImportedOrgan withBoundary(mesh::TetMesh tets) {
  ImportedOrgan organ{std::move(tets), {}, {}};
  organ.boundary = mesh::boundaryOf(organ.mesh);
  return organ;
}

ImportedOrgan importFile(const Arguments& arguments) {
  ImportOptions options;
  options.scale = arguments.scale;
  options.element_size = arguments.element_size.value_or(options.element_size);
  if (arguments.fixed) options.fixed = parseFixedRule(*arguments.fixed);
  ImportedOrgan organ = importOrgan(arguments.input, options);
  renumber(organ.mesh);
  return organ;
}

int body(int argc, char** argv) {
  // 1. What to make.
  program::CommandLine line(
      "palpate-organ",
      "Makes and imports organ meshes: metres, linear tetrahedra, groups `fixed` and `accessible`.");
  Arguments arguments;
  const program::Options liver = addLiver(line.options(), arguments);
  const program::Options beam = addBeam(line.options(), arguments);
  addImport(line.options(), arguments);
  if (!line.read(argc, argv)) return 0;
  // 2. The organ.
  const ImportedOrgan organ =
      liver.chosen()  ? withBoundary(makeLiver(arguments.element_size.value_or(kLiverElementSize)))
      : beam.chosen() ? withBoundary(mesh::makeBeam())
                      : importFile(arguments);
  // 3. Its file, and what is in it.
  mesh::writeMsh(arguments.output, organ.mesh, organ.boundary);
  const Report report = makeReport(arguments.output, organ.mesh, organ.boundary, organ.notes);
  if (arguments.json) program::printJson(toJson(report));
  print(arguments.json ? std::cerr : std::cout, report);
  return 0;
}

}  // namespace
}  // namespace palpate::organ

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-organ", &palpate::organ::body, argc, argv);
}
