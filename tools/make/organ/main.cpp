// SPDX-License-Identifier: Apache-2.0
// palpate-organ makes and imports organ meshes. See README.md.
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "tools/make/organ/import_organ.h"
#include "tools/make/organ/liver.h"
#include "tools/make/organ/liver_case.h"
#include "tools/make/organ/output_file.h"
#include "tools/make/organ/paper_liver.h"
#include "tools/make/organ/preview.h"
#include "tools/make/organ/progress.h"
#include "tools/make/organ/report.h"
#include "tools/mesh/box_mesh.h"
#include "tools/mesh/quadratic.h"
#include "tools/mesh/topology.h"
#include "tools/program/command_line.h"
#include "tools/program/length_unit.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"

namespace palpate::organ {
namespace {

struct Arguments {
  std::string output, input;
  std::optional<std::string> case_file, unit, part, picture;
  std::vector<std::string> fixed;
  std::optional<double> element_size, inner_size, growth, scale;
  std::optional<int> element_order;
  double max_nodes{kMaxNodes};
  bool json{false}, repair{false}, dry_run{false};
};

// The kinds of organ. Each option stands where it means something.
struct Commands {
  program::Options liver, paper_liver, beam, import;
};

program::Options addCommand(program::Options line, const char* name, const char* help, Arguments& arguments) {
  program::Options command = line.subcommand(name, help);
  command.add(
      "-o,--output", &arguments.output,
      "The file to write: .msh (Gmsh 4.1), or .vtk to look at, without groups (needed, but for --dry-run)");
  command.flag("--json", &arguments.json, "Print one JSON object on standard output");
  return command;
}

void addSizes(program::Options& command, Arguments& arguments, double smallest, double largest,
              const std::string& element_size, const std::string& inner_size) {
  command
      .add("--element-size", &arguments.element_size,
           "Edge length at the surface (default: " + element_size + ")")
      .range(smallest, largest, "m");
  command
      .add("--inner-size", &arguments.inner_size, "Largest edge length inside (default: " + inner_size + ")")
      .unit("m");
  command
      .add("--growth", &arguments.growth,
           "Edge length inside over the distance to the surface, relative (default: 0.5)")
      .range(0.01, 2.0);
}

void addOrder(program::Options& command, Arguments& arguments, const std::string& order) {
  command
      .add("--element-order", &arguments.element_order,
           "Order of the elements: 1, four nodes; 2, ten nodes (default: " + order + ")")
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
  addSizes(commands.liver, arguments, 0.003, 0.02, "0.008", "0.02");
  addOrder(commands.liver, arguments, "2");
  commands.liver.add("--case", &arguments.case_file,
                     "Also write a case file for palpate-solve: soft liver, a stiff nodule");
  commands.liver.example("palpate-organ liver -o liver.msh --case liver.toml");
  commands.paper_liver
      .add("--element-size", &arguments.element_size, "Edge length of the tetrahedra (default: 0.0067)")
      .range(0.003, 0.02, "m");
  addOrder(commands.paper_liver, arguments, "1");
  commands.paper_liver.example("palpate-organ paper-liver --element-size 0.01 -o paper.msh");
  commands.beam.example("palpate-organ beam -o beam.msh");
  commands.import.add("file", &arguments.input, "The mesh or surface to import").required();
  commands.import.add("--unit", &arguments.unit, "Unit of the file's lengths (default: m)")
      .oneOf(program::lengthUnitWords());
  commands.import
      .add("--scale", &arguments.scale, "Size of a unit of the file, in the place of --unit (default: 1)")
      .range(1e-12, 1e12, "m");
  commands.import.flag(
      "--repair", &arguments.repair,
      "Repair a surface: turn parts over, merge vertices, leave out twins and flat triangles, repair where "
      "triangles cross, fill holes of up to a quarter of the body's diagonal; says what changed");
  commands.import.add("--part", &arguments.part,
                      "Which part of a surface of several: largest, or its number by size, from 1");
  commands.import
      .add("--fixed", &arguments.fixed,
           "What is held: group:NAME of the file (.obj: a group or material), a side (-x, +z, ...), "
           "normal:x,y,z[,degrees] within which triangles face (default: 30), box:x0,y0,z0,x1,y1,z1 in m "
           "after "
           "scaling, or lowest-z:FRACTION of the "
           "surface "
           "nodes. Several unite (default: the file's group 'fixed')")
      .oneWordEach();
  commands.import
      .add("--max-nodes", &arguments.max_nodes, "Refuse to fill a surface with more nodes than this")
      .range(100.0, 1e8, "nodes");
  commands.import.flag("--dry-run", &arguments.dry_run,
                       "Fill nothing: say what would be held and what can be touched");
  commands.import.add("--picture", &arguments.picture,
                      "With --dry-run: draw what would be held and touched into this .svg");
  addSizes(commands.import, arguments, 1e-6, 1e3, "a surface keeps its triangles", "as at the surface");
  addOrder(commands.import, arguments, "that of the file");
  const char* const scan =
      "palpate-organ import scan.stl --unit mm --repair --element-size 0.008 --fixed -z -o organ.msh";
  commands.import.example(scan);
  line.example(scan);
  return commands;
}

mesh::ElementSizes sizesOf(const Arguments& arguments, const mesh::ElementSizes& defaults) {
  return {arguments.element_size.value_or(defaults.surface), arguments.inner_size.value_or(defaults.inner),
          arguments.growth.value_or(defaults.growth)};
}

void tellProgress(const std::string& line) {
  std::cerr << "progress         " << line << std::endl;
}

mesh::TetMesh liver(const Arguments& arguments) {
  const Progress progress(tellProgress);
  LiverOptions options;
  options.sizes = sizesOf(arguments, options.sizes);
  options.order = arguments.element_order.value_or(options.order);
  return makeLiver(options).mesh;
}

mesh::TetMesh paperLiver(const Arguments& arguments) {
  const Progress progress(tellProgress);
  const mesh::TetMesh mesh = makePaperLiver(arguments.element_size.value_or(kPaperLiverElementSize));
  return arguments.element_order == 2 ? mesh::quadraticOf(mesh) : mesh;
}

ImportedOrgan withBoundary(mesh::TetMesh tets) {
  ImportedOrgan organ{std::move(tets), {}, {}};
  organ.boundary = mesh::boundaryOf(organ.mesh);
  return organ;
}

double scaleOf(const Arguments& arguments) {
  if (arguments.scale && arguments.unit)
    throw program::UsageError("--unit and --scale say the same: give one of them");
  return arguments.unit ? program::lengthUnit(*arguments.unit).metres : arguments.scale.value_or(1);
}

ImportOptions importOptions(const Arguments& arguments) {
  ImportOptions options;
  options.scale = scaleOf(arguments);
  options.sizes = sizesOf(arguments, options.sizes);
  options.order = arguments.element_order;
  options.repair = arguments.repair;
  options.part = arguments.part;
  options.max_nodes = arguments.max_nodes;
  options.say = [&](const std::string& line) {
    (arguments.json ? std::cerr : std::cout) << line << std::endl;
  };
  options.progress = tellProgress;
  for (const auto& rule : arguments.fixed) options.fixed.push_back(parseFixedRule(rule));
  return options;
}

ImportedOrgan importFile(const Arguments& arguments) {
  ImportedOrgan organ = importOrgan(arguments.input, importOptions(arguments));
  renumber(organ.mesh);
  return organ;
}

// Before anything is made.
void checkOutputs(const Arguments& arguments) {
  if (arguments.picture && !arguments.dry_run) throw program::UsageError("--picture is for --dry-run");
  if (arguments.picture) program::checkOutput("--picture", *arguments.picture);
  if (!arguments.dry_run && arguments.output.empty()) throw program::UsageError("--output is required");
  if (!arguments.output.empty()) checkOutput(arguments.output);
  if (arguments.case_file) program::checkOutput("--case", *arguments.case_file);
}

void preview(const Arguments& arguments) {
  const Preview seen = previewOrgan(arguments.input, importOptions(arguments));
  if (arguments.picture) program::writeFile(*arguments.picture, clampPicture(seen));
  if (arguments.json) program::printJson(toJson(seen));
  std::ostream& out = arguments.json ? std::cerr : std::cout;
  print(out, seen);
  out << "dry run          nothing was filled; picture: "
      << arguments.picture.value_or("none, --picture FILE.svg draws it") << '\n';
}

int body(int argc, char** argv) {
  // 1. What to make.
  program::CommandLine line(
      "palpate-organ",
      "Makes and imports organ meshes: metres, tetrahedra, groups `fixed` and `accessible`.");
  Arguments arguments;
  const Commands commands = addCommands(line.options(), arguments);
  if (!line.read(argc, argv)) return program::kDone;
  checkOutputs(arguments);
  if (arguments.dry_run) {
    preview(arguments);
    return program::kDone;
  }
  // 2. The organ.
  ImportedOrgan organ = commands.liver.chosen()         ? withBoundary(liver(arguments))
                        : commands.paper_liver.chosen() ? withBoundary(paperLiver(arguments))
                        : commands.beam.chosen()        ? withBoundary(mesh::makeBeam())
                                                        : importFile(arguments);
  // 3. Its file, and what is in it.
  writeOrgan(arguments.output, organ.mesh, organ.boundary, organ.notes);
  if (arguments.case_file) writeLiverCase(*arguments.case_file, arguments.output);
  const Report report = makeReport(arguments.output, organ.mesh, organ.boundary, organ.notes);
  if (arguments.json) program::printJson(toJson(report));
  print(arguments.json ? std::cerr : std::cout, report);
  return program::kDone;
}

}  // namespace
}  // namespace palpate::organ

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-organ", &palpate::organ::body, argc, argv);
}
