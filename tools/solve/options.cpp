// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <sstream>

namespace palpate::solve {

namespace {

/// Three numbers, not all zero, or "any".
void setDirection(const std::string& text, offline::LoadCase& load) {
  load.direction.reset();
  load.any_direction = text == "any";
  if (load.any_direction) return;
  std::istringstream in(text);
  offline::Vec3 x = offline::Vec3::Zero();
  char first = 0, second = 0;
  in >> x[0] >> first >> x[1] >> second >> x[2];
  const bool read = !in.fail() && first == ',' && second == ',' && (in >> std::ws).eof();
  if (!read || !x.allFinite() || !(x.norm() > 0.0))
    throw offline::CaseError("--load-direction " + text +
                             " is neither three numbers x,y,z, not all zero, nor any");
  load.direction = x.stableNormalized();
}

void override(const Options& options, offline::Case& c) {
  if (options.method) {
    try {
      c.method = offline::methodOf(*options.method);
    } catch (const offline::CaseError& error) {
      throw offline::CaseError(std::string("--method ") + error.what());
    }
  }
  if (options.modes) c.modes = options.modes;
  if (options.order) c.order = options.order;
  if (options.steps) c.load.steps = options.steps;
  if (options.load) c.load.magnitude = options.load;
  if (options.direction) setDirection(*options.direction, c.load);
}

}  // namespace

void describe(CLI::App& app, Options& options) {
  app.add_option("input", options.input,
                 "case file (.toml), or a mesh in metres to be solved with the defaults")
      ->required();
  app.add_option("-o,--output", options.output, "model file to write")->capture_default_str();
  app.add_option("--method", options.method,
                 "series-displacement (the default), series-force, pgd-linear, pgd-explicit or pgd-euler");
  app.add_option("--modes", options.modes, "modes of the model")->check(CLI::Range(1, 2000));
  app.add_option("--order", options.order, "degree of the series")->check(CLI::Range(1, 7));
  app.add_option("--load-direction", options.direction, "PGD methods: x,y,z; pgd-linear also: any");
  app.add_option("--load", options.load, "PGD methods: magnitude of the load, N")
      ->check(CLI::Range(1e-300, 1e6));
  app.add_option("--steps", options.steps, "pgd-explicit, pgd-euler: load steps")
      ->check(CLI::Range(1, 100000));
  app.add_option("--storage", options.storage,
                 "modes: mixed (8 to 16 bits or float32, each as its rounding allows) or float32")
      ->check(CLI::IsMember({"mixed", "float32"}))
      ->capture_default_str();
  app.add_option("--scratch", options.scratch, "folder of the scratch file (default: beside the output)");
  app.add_option("--threads", options.threads, "worker threads")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_flag("--json", options.json, "print one JSON object on standard output");
  app.add_flag("-q,--quiet", options.quiet, "no progress");
}

offline::Case readCase(const Options& options) {
  offline::Case c = options.input.extension() == ".toml" ? offline::readCase(options.input)
                                                         : offline::defaultCase(options.input);
  override(options, c);
  try {
    offline::checkCase(c);
  } catch (const offline::CaseError& error) {
    throw offline::CaseError(options.input.string() + ": " + error.what());
  }
  return c;
}

}  // namespace palpate::solve
