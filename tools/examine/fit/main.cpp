// SPDX-License-Identifier: Apache-2.0
// palpate-fit: Young's modulus of a soft organ from force against depth, measured at one point of it.
//
// Sample runs:  palpate-fit --model liver.h5 --measured curve.csv --at 0.02,0,0.06
//               palpate-fit --model liver.h5 --measured curve.csv --node 1204 --direction 0,0,-1 --json --plot fit.svg
//               palpate-fit --model liver.h5 --measured curve.csv --node 1204 --no-offset --write softer.h5
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>

#include "tools/examine/fit/findings.h"
#include "tools/examine/fit/fit_error.h"
#include "tools/examine/fit/fit_plot.h"
#include "tools/examine/fit/model_error.h"
#include "tools/examine/fit/report.h"
#include "tools/examine/query/place.h"
#include "tools/modelfile/scale_model.h"
#include "tools/program/command_line.h"
#include "tools/program/numbers.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"

namespace palpate::fit {
namespace {

struct Options {
  std::string model, measured, at, direction, force{"along"}, plot, write;
  std::optional<std::int64_t> node;
  std::optional<double> deepest;
  double confidence{0.99};
  bool no_offset{false}, json{false};
};

void describe(program::Options line, Options& options) {
  line.add("--model", &options.model, "model file (.h5), driven by displacement").required();
  line.add("--measured", &options.measured,
           "table of force against depth (.csv): a line such as depth_mm,force_N, then readings")
      .required();
  program::Options where = line.exactlyOneOf("where");
  where.add("--node", &options.node, "measured at this surface node, by its number in the mesh file");
  where.add("--at", &options.at,
            "measured at the surface point nearest to x,y,z, m, no farther than the patch's radius");
  line.add("--direction", &options.direction, "the tool went along dx,dy,dz (default: against the normal)");
  line.add("--force", &options.force,
           "what of the force was measured: its part along the direction, or its size")
      .oneOf({"along", "size"});
  line.flag("--no-offset", &options.no_offset,
            "contact begins at depth 0; else the fit finds where contact begins");
  line.add("--deepest", &options.deepest, "leave out readings of more depth").unit("m");
  line.add("--confidence", &options.confidence, "of the interval of E").range(0.5, 0.9999);
  line.add("--plot", &options.plot, "draw points, curve and residuals (.svg)");
  line.add("--write", &options.write, "write a copy of the model that has the E that was found (.h5)");
  line.flag("--json", &options.json, "print one JSON object on standard output");
  line.example("palpate-fit --model liver.h5 --measured curve.csv --at 0.02,0,0.06 --plot fit.svg");
}

Vec3 vectorOf(const std::string& option, const std::string& text) {
  const std::array<double, 3> x = program::parseVector(option, text);
  return {x[0], x[1], x[2]};
}

MetaModel modelOf(const Options& options) {
  MetaModel model = MetaModel::load(options.model);
  if (!model.isDisplacementDriven())
    throw FitError(options.model + " is driven by " + std::string(toString(model.attributes().parameters)) +
                   "; fit takes displacement models");
  return model;
}

MeasuredCurve curveOf(const Options& options) {
  MeasuredCurve curve = readCurve(options.measured);
  if (!options.deepest) return curve;
  std::erase_if(curve.points, [&](const MeasuredPoint& point) { return !(point.depth <= *options.deepest); });
  return curve;
}

query::Anchor anchorOf(const MetaModel& model, const Options& options) {
  if (options.node) return query::anchorAtNode(model, *options.node);
  return query::anchorOf(model, {"--at", program::parseVector("--at", options.at)});
}

Vec3 directionOf(const MetaModel& model, const ContactPoint& s, const Options& options) {
  if (options.direction.empty()) return -model.surface().normal(s);
  const Vec3 d = vectorOf("--direction", options.direction);
  if (!(d.norm() > 0.0))
    throw program::ValueError("--direction is '" + options.direction + "', expected a vector of some length");
  return d.normalized();
}

/// What the file of the new modulus says of its making.
std::string provenanceOf(const Findings& found, const Options& options) {
  const auto [low, high] = found.interval();
  auto provenance = program::Json::read(found.model.attributes().provenance);
  if (!provenance || !provenance->isObject()) provenance = program::Json::object();
  (*provenance)["fitted"] = {{"program", "palpate-fit"},
                             {"version", PALPATE_VERSION},
                             {"measured", options.measured},
                             {"from_model", found.model.id()},
                             {"from_E", found.model.attributes().E},
                             {"E_low", low},
                             {"E_high", high},
                             {"confidence", found.options.confidence}};
  return provenance->dump();
}

/// @return the new model's id
std::string writeCopy(const Findings& found, const Options& options) {
  modelfile::writeScaled(options.write, found.model, found.E(), provenanceOf(found, options));
  return MetaModel::load(options.write).id();
}

void report(const Findings& found, const Options& options, const std::string& written) {
  for (const std::string& warning : warnings(found)) std::cerr << "palpate-fit: " << warning << '\n';
  if (!options.json) {
    std::cout << toText(found);
    if (!written.empty())
      std::cout << "written           " << options.write << ", model " << written
                << ", without a certificate: palpate-certify makes one\n";
    return;
  }
  program::Json json = toJson(found);
  json["model"] = options.model;
  json["model_id"] = found.model.id();
  json["measured"] = options.measured;
  json["written"] = written.empty() ? program::Json(nullptr) : program::Json(options.write);
  json["written_id"] = written.empty() ? program::Json(nullptr) : program::Json(written);
  std::cout << json.dump(2, program::Keys::kAsWritten) << '\n';
}

/// @throw FitError, program::ValueError
void checkNumbers(const Options& options) {
  if (!options.node) (void)program::parseVector("--at", options.at);
  if (!options.direction.empty()) (void)program::parseVector("--direction", options.direction);
  if (options.deepest && !std::isfinite(*options.deepest))
    throw FitError("--deepest is " + std::to_string(*options.deepest) + ", expected a finite depth in m");
}

/// No file that is written is one that is read, or the other one that is written. @throw FitError
void checkFiles(const Options& options) {
  const auto checkOther = [](const char* option, const std::string& written, const char* taken,
                             const std::string& file) {
    if (!written.empty() && !file.empty() && program::isSameFile(written, file))
      throw FitError(std::string(option) + " is the file of " + taken + ", " + written +
                     ": expected another file");
  };
  checkOther("--plot", options.plot, "--model", options.model);
  checkOther("--plot", options.plot, "--measured", options.measured);
  checkOther("--write", options.write, "--model", options.model);
  checkOther("--write", options.write, "--measured", options.measured);
  checkOther("--write", options.write, "--plot", options.plot);
  program::checkOutput("--plot", options.plot);
  program::checkOutput("--write", options.write);
}

void run(const Options& options) {
  program::orUsageError([&] {
    checkNumbers(options);
    checkFiles(options);
  });
  // 1. The model and the curve.
  const MetaModel model = modelOf(options);
  const MeasuredCurve curve = curveOf(options);
  // 2. The place, and what the model answers there.
  const query::Anchor anchor = anchorOf(model, options);
  const Vec3 direction = directionOf(model, anchor.s, options);
  const Measured measured = options.force == "size" ? Measured::kSize : Measured::kAlong;
  const Press press(model, anchor.s, direction, measured);
  // 3. The modulus.
  const auto certified = certifiedError(model.attributes(), press);
  const FitOptions how{!options.no_offset, options.confidence, certified.value_or(assumedError(press))};
  const Findings found{model,
                       curve,
                       press,
                       anchor,
                       direction,
                       measured,
                       how,
                       certified.has_value(),
                       estimate(curve, press, how)};
  // 4. Files, then the report.
  if (!options.plot.empty())
    program::writeFile(options.plot,
                       fitPlot(std::filesystem::path(options.measured).filename().string() + " by " +
                                   std::filesystem::path(options.model).filename().string(),
                               found));
  report(found, options, options.write.empty() ? std::string() : writeCopy(found, options));
}

int body(int argc, char** argv) {
  program::CommandLine line(
      "palpate-fit", "Finds an organ's Young's modulus from force against depth, measured at one point.");
  Options options;
  describe(line.options(), options);
  if (!line.read(argc, argv)) return program::kDone;
  run(options);
  return program::kDone;
}

}  // namespace
}  // namespace palpate::fit

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-fit", &palpate::fit::body, argc, argv);
}
