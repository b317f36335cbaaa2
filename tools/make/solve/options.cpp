// SPDX-License-Identifier: Apache-2.0
#include "tools/make/solve/options.h"

#include <sstream>

namespace palpate::solve_program {

namespace {

/// Three numbers, not all zero, or "any".
void setDirection(const std::string& text, solver::LoadCase& load) {
  load.direction.reset();
  load.any_direction = text == "any";
  if (load.any_direction) return;
  std::istringstream in(text);
  solver::Vec3 x = solver::Vec3::Zero();
  char first = 0, second = 0;
  in >> x[0] >> first >> x[1] >> second >> x[2];
  const bool read = !in.fail() && first == ',' && second == ',' && (in >> std::ws).eof();
  if (!read || !x.allFinite() || !(x.norm() > 0.0))
    throw program::UsageError("--load-direction " + text +
                              " is neither three numbers x,y,z, not all zero, nor any");
  load.direction = x.stableNormalized();
}

/// In the place of what a case for another target says of size and exactness.
void setTarget(const std::string& name, solver::Case& c) {
  if (name != "server" && name != "handheld")
    throw program::UsageError("--target " + name + " is not known (known: server, handheld)");
  const solver::Target target = name == "handheld" ? solver::Target::kHandheld : solver::Target::kServer;
  if (target == c.target) return;
  c.target = target;
  for (std::optional<double>* key :
       {&c.travel, &c.size_limit, &c.near_radius, &c.force_error, &c.field_error})
    key->reset();
  for (std::optional<int>* key : {&c.order, &c.force_order, &c.modes}) key->reset();
}

/// @throw program::UsageError
void override(const Options& options, solver::Case& c) {
  if (options.method)
    program::orUsageError([&] { c.method = solver::methodOf(*options.method); }, "--method ");
  if (options.law) {
    program::orUsageError([&] { (void)solver::lawOf(*options.law); }, "--law ");
    c.law = *options.law;
  }
  c.mesh_error = c.mesh_error || options.mesh_error;
  if (options.element_order) c.element_order = options.element_order;
  if (options.target) setTarget(*options.target, c);
  if (options.size_limit) c.size_limit = options.size_limit;
  if (options.modes) {
    c.modes = options.modes;
    c.field_error.reset();
  }
  if (options.order) {
    c.order = options.order;
    c.force_order.reset();
    c.travel.reset();
  }
  if (options.travel) {
    if (options.order) throw program::UsageError("--travel does not go with --order: it chooses it");
    c.travel = options.travel;
    c.order.reset();
    c.force_order.reset();
  }
  if (options.force_error) c.force_error = options.force_error;
  if (options.field_error) {
    if (options.modes)
      throw program::UsageError("--field-error does not go with --modes: it chooses their number");
    c.field_error = options.field_error;
    c.modes.reset();
  }
  if (options.steps) c.load.steps = options.steps;
  if (options.load) c.load.magnitude = options.load;
  if (options.direction) setDirection(*options.direction, c.load);
}

bool holds(const solver::Case& c) {
  try {
    solver::checkCase(c);
    return true;
  } catch (const solver::CaseError&) {
    return false;
  }
}

}  // namespace

void describe(program::Options line, Options& options) {
  line.add("input", &options.input, "case file (.toml), or a mesh in metres to be solved with the defaults");
  line.add(
      "-o,--output", &options.output,
      "file to write (default: model.h5); of a batch the folder of its models (default: that of its cases)");
  line.add(
      "--batch", &options.batch,
      "solve all case files (*.toml) of a folder that have no model yet, or one of another case; what one "
      "fails of does not end the others");
  line.add("--worker", &options.worker,
           "of a batch: the I-th of N programs that share it (I/N), each with every N-th case");
  line.flag("--template", &options.case_template,
            "write a case file (.toml) with every key, its default, unit and range, on standard output or to "
            "-o, and "
            "stop; an input is the mesh that it names");
  line.add("--method", &options.method,
           "series-displacement (the default), series-force, pgd-linear, pgd-explicit or pgd-euler");
  line.add("--law", &options.law, "law of the material: stvk (the default) or stable-neo-hookean");
  line.add("--element-order", &options.element_order,
           "raise a linear mesh to quadratic elements (2), or not (1) (default: 2 for series-displacement "
           "and nu > 0.3)")
      .range(1, 2);
  line.flag("--mesh-error", &options.mesh_error,
            "say by how much the mesh makes the organ too stiff: 12 places with better elements");
  line.add("--modes", &options.modes,
           "modes of the model (default: 167; series-displacement: as many as the field's error wants)")
      .range(1, 2000);
  line.add("--order", &options.order,
           "degree of the series (default: 3; series-displacement: chosen by the travel); a force_order or "
           "travel "
           "of the case no longer holds")
      .range(1, 7);
  line.add("--travel", &options.travel,
           "series-displacement: how far tools press, m; chooses the degrees of fields and force, for those "
           "of the case (default: 0.007 where E is below 50 kPa, else 0.005)")
      .range(1e-9, solver::kLargestRadius);
  line.add("--force-error", &options.force_error,
           "series-displacement: asked error of the force within the domain, relative (default: 0.01)")
      .range(1e-9, 0.999);
  line.add("--field-error", &options.field_error,
           "series-displacement: asked largest error of the field, relative to abs(d); chooses modes, near "
           "fields and "
           "edges "
           "(default: 0.01)")
      .range(1e-9, 0.999);
  line.add("--target", &options.target,
           "server (the default), or handheld: a small file for a phone or a page, of order 3 and 4 mm of "
           "travel, or of "
           "order 5 where the travel is longer; for what the case says of these");
  line.add(
          "--size-limit", &options.size_limit,
          "handheld: of the file, bytes (default: 8e6 at order 3, 20e6 above); chooses modes and near fields")
      .range(1e5, 1e12);
  line.add("--load-direction", &options.direction, "PGD methods: x,y,z; pgd-linear also: any");
  line.add("--load", &options.load,
           "PGD methods: magnitude of the load (default: what moves the contact by 2 mm)")
      .range(1e-300, 1e6, "N");
  line.add("--steps", &options.steps, "pgd-explicit, pgd-euler: load steps").range(1, 100000);
  line.add("--scratch", &options.scratch,
           "folder of OUTPUT.partial, with which the same command goes on where it was interrupted (default: "
           "beside the output)");
  line.flag("--fresh", &options.fresh, "throw away what an interrupted run has left, and begin again");
  line.add("--threads", &options.threads,
           "worker threads (of several processes, each has one unless more are given)")
      .range(1, 1024);
  line.flag("--dry-run", &options.dry_run,
            "series-displacement: measure a few positions, say what the whole takes, and stop");
  line.flag("--json", &options.json, "print one JSON object on standard output");
  line.flag("-q,--quiet", &options.quiet, "no progress");
  line.example("palpate-solve liver.msh -o liver.h5");
}

void checkOptions(const Options& options) {
  solver::Case usual;
  override(options, usual);
}

solver::Case readCase(const Options& options) {
  const solver::Case own = options.input.extension() == ".toml" ? solver::readCase(options.input)
                                                                : solver::defaultCase(options.input);
  solver::Case c = own;
  override(options, c);
  try {
    solver::checkCase(c);
  } catch (const solver::CaseError& error) {
    const std::string words = options.input.string() + ": " + error.what();
    if (holds(own)) throw program::UsageError(words);
    throw solver::CaseError(words);
  }
  return c;
}

}  // namespace palpate::solve_program
