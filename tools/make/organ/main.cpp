// SPDX-License-Identifier: Apache-2.0
// palpate-organ makes and imports organ meshes. See README.md.
#include <iostream>
#include <optional>
#include <string>

#include "tools/make/organ/import_organ.h"
#include "tools/make/organ/liver.h"
#include "tools/make/organ/liver_case.h"
#include "tools/make/organ/paper_liver.h"
#include "tools/make/organ/report.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/topology.h"
#include "tools/mesh/write_msh.h"
#include "tools/program/command_line.h"
#include "tools/program/run.h"

namespace palpate::organ {
namespace {

struct Arguments {
  std::string output, input;
  std::optional<std::string> fixed, case_file;
  std::optional<double> element_size, inner_size, growth;
  std::optional<int> element_order;
  double scale{1};
  bool json{false};
};

// The kinds of organ. Each option stands where it means something.
struct Commands {
  program::Options liver, paper_liver, beam, import;
};

program::Options addCommand(program::Options line, const char* name, const char* help, Arguments& arguments) {
  program::Options command = line.subcommand(name, help);
  command.add("-o,--output", &arguments.output, "The .msh file to write (Gmsh 4.1)").required();
  command.flag("--json", &arguments.json, "Print one JSON object on standard output");
  return command;
}

void addSizes(program::Options& command, Arguments& arguments, const std::string& element_size,
              const std::string& inner_size) {
  command.add("--element-size", &arguments.element_size,
              "Edge length at the surface, m [" + element_size + "]");
  command.add("--inner-size", &arguments.inner_size, "Largest edge length inside, m [" + inner_size + "]");
  command.add("--growth", &arguments.growth, "Edge length per distance to the surface [0.5]");
}

void addOrder(program::Options& command, Arguments& arguments, const std::string& order) {
  command
      .add("--element-order", &arguments.element_order,
           "Order of the elements: 1, four nodes; 2, ten nodes [" + order + "]")
      .range(1, 2);
}

Commands addCommands(program::Options line, Arguments& arguments) {
  Commands commands{
      addCommand(line, "liver", "Make the default organ, a liver of 0.22 m with a nodule in it", arguments),
      addCommand(line, "paper-liver",
                 "Make the liver-like body of about 0.22 x 0.13 x 0.12 m of the comparisons with the paper",
                 arguments),
      addCommand(line, "beam", "Make the beam of 400 x 40 x 40 mm, clamped at x = 0", arguments),
      addCommand(line, "import",
                 "Import a mesh (.msh 1, 2, 4; .vtk; .mesh) or fill a closed surface (.stl, .obj). Nodes are "
                 "numbered from 1 in the file's order.",
                 arguments)};
  addSizes(commands.liver, arguments, "0.008", "0.02");
  addOrder(commands.liver, arguments, "2");
  commands.liver.add("--case", &arguments.case_file,
                     "Also write a case file for palpate-solve: soft liver, a stiff nodule");
  commands.paper_liver.add("--element-size", &arguments.element_size,
                           "Edge length of the tetrahedra, m [0.0067]");
  addOrder(commands.paper_liver, arguments, "1");
  commands.import.add("file", &arguments.input, "The mesh to import").required();
  commands.import.add("--scale", &arguments.scale, "Metres per unit of the file");
  commands.import.add(
      "--fixed", &arguments.fixed,
      "What is held: group:NAME, lowest-z:FRACTION of the surface nodes, or box:x0,y0,z0,x1,y1,z1 in m "
      "after scaling [the file's group 'fixed']");
  addSizes(commands.import, arguments, "a surface keeps its triangles", "as at the surface");
  addOrder(commands.import, arguments, "that of the file");
  return commands;
}

mesh::ElementSizes sizesOf(const Arguments& arguments, const mesh::ElementSizes& defaults) {
  return {arguments.element_size.value_or(defaults.surface), arguments.inner_size.value_or(defaults.inner),
          arguments.growth.value_or(defaults.growth)};
}

mesh::TetMesh liver(const Arguments& arguments) {
  LiverOptions options;
  options.sizes = sizesOf(arguments, options.sizes);
  options.order = arguments.element_order.value_or(options.order);
  return makeLiver(options).mesh;
}

mesh::TetMesh paperLiver(const Arguments& arguments) {
  const mesh::TetMesh mesh = makePaperLiver(arguments.element_size.value_or(kPaperLiverElementSize));
  return arguments.element_order == 2 ? mesh::quadraticOf(mesh) : mesh;
}

ImportedOrgan withBoundary(mesh::TetMesh tets) {
  ImportedOrgan organ{std::move(tets), {}, {}};
  organ.boundary = mesh::boundaryOf(organ.mesh);
  return organ;
}

ImportedOrgan importFile(const Arguments& arguments) {
  ImportOptions options;
  options.scale = arguments.scale;
  options.sizes = sizesOf(arguments, options.sizes);
  options.order = arguments.element_order;
  if (arguments.fixed) options.fixed = parseFixedRule(*arguments.fixed);
  ImportedOrgan organ = importOrgan(arguments.input, options);
  renumber(organ.mesh);
  return organ;
}

int body(int argc, char** argv) {
  // 1. What to make.
  program::CommandLine line(
      "palpate-organ",
      "Makes and imports organ meshes: metres, tetrahedra, groups `fixed` and `accessible`.");
  Arguments arguments;
  const Commands commands = addCommands(line.options(), arguments);
  if (!line.read(argc, argv)) return 0;
  // 2. The organ.
  const ImportedOrgan organ = commands.liver.chosen()         ? withBoundary(liver(arguments))
                              : commands.paper_liver.chosen() ? withBoundary(paperLiver(arguments))
                              : commands.beam.chosen()        ? withBoundary(mesh::makeBeam())
                                                              : importFile(arguments);
  // 3. Its file, and what is in it.
  mesh::writeMsh(arguments.output, organ.mesh, organ.boundary);
  if (arguments.case_file) writeLiverCase(*arguments.case_file, arguments.output);
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
