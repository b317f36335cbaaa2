// SPDX-License-Identifier: Apache-2.0
// palpate-query: asks a model what one touch would feel like, and checks it against the full solution.
//
// Sample runs:  palpate-query liver.h5 --node 1204 --displacement 0,0,-0.002
//               palpate-query liver.h5 --at 0.05,0.01,0.06 --displacement -0.001,0,-0.002 --newton --json
//               palpate-query liver.h5 --node 1204 --displacement 0,0,-0.002 --ccx deck.inp --field touch.vtu
//               palpate-query force.h5 --node 1204 --force 0,0,-0.5 --newton
//               palpate-query liver.h5 --node 1204 --displacement 0,0,-0.002 --tool2 87:0,0,-0.002 --newton
//               palpate-query level.h5 --node 1204 --load-level 0.75 --newton
//               palpate-query liver.h5 --batch touches.csv --unit mm -o answers.csv
#include <cmath>
#include <iostream>
#include <optional>
#include <span>

#include "core/data/model_view.h"
#include "tools/examine/query/arguments.h"
#include "tools/examine/query/batch.h"
#include "tools/examine/query/ccx_deck.h"
#include "tools/examine/query/field_file.h"
#include "tools/examine/query/place.h"
#include "tools/examine/query/report.h"
#include "tools/examine/query/report_together.h"
#include "tools/program/command_line.h"
#include "tools/program/numbers.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"

namespace {

using namespace palpate;

struct Options {
  std::string model, at, batch, output, unit{"m"};
  std::optional<std::string> displacement, force;
  std::optional<std::int64_t> node;
  std::optional<double> level;
  std::vector<std::string> more_tools;
  std::string deck, field;
  int steps{1};
  bool newton{false};
  bool json{false};
};

void describe(program::Options line, Options& options) {
  line.add("model", &options.model, "model file (.h5)").required();
  program::Options where = line.exactlyOneOf("where");
  where.add("--node", &options.node, "touch this surface node, by its number in the mesh file");
  where.add(
      "--at", &options.at,
      "touch the surface point nearest to x,y,z; refused farther from the surface than the patch's radius");
  where.add("--batch", &options.batch,
            "answer each line of a table (.csv) of places and displacements, see below");
  program::Options what = line.atMostOneOf("what");
  what.add("--displacement", &options.displacement, "displacement dx,dy,dz of the contact patch");
  what.add("--force", &options.force, "force fx,fy,fz of the tool, at most 1e6 N (models driven by force)");
  what.add("--load-level", &options.level,
           "share of the model's load (models driven by level; leave out for others)")
      .range(0.0, 1.0);
  line.add("--tool2", &options.more_tools,
           "another tool at the same time: NODE:dx,dy,dz; goes with --displacement, may be repeated")
      .oneWordEach();
  line.add("--unit", &options.unit,
           "of places and displacements in --at, --displacement, --tool2 and --batch")
      .oneOf(program::lengthUnitWords());
  line.add("-o,--output", &options.output,
           "with --batch: write the answers there (.csv), not on standard output");
  line.flag("--newton", &options.newton, "solve the full problem too, and tell how far the model is off");
  line.add("--steps", &options.steps, "load steps of the full solution to begin with").range(1, 1000);
  line.add("--ccx", &options.deck, "write the full problem as a CalculiX deck (implies --newton)");
  line.add("--field", &options.field, "write the surface displacement as VTK (.vtu)");
  line.flag("--json", &options.json, "print one JSON object on standard output");
}

Vec3 vectorOf(const std::string& option, const std::string& text) {
  const std::array<double, 3> x = program::parseVector(option, text);
  return {x[0], x[1], x[2]};
}

program::AskedPlace asked(const std::string& option, const program::Point& numbers, const Options& options) {
  return {option, numbers, program::lengthUnit(options.unit), true};
}

query::Anchor anchorOf(const MetaModel& model, const Options& options) {
  if (options.node) return query::anchorAtNode(model, *options.node);
  return query::anchorOf(model, asked("--at", program::parseVector("--at", options.at), options));
}

/// The square of a much larger force overflows, and with it the residual that Newton is judged by.
Vec3 forceOf(const std::string& text) {
  constexpr double kLargest = 1e6;  // N, as of palpate-solve --load
  const Vec3 f = vectorOf("--force", text);
  if (!(f.norm() <= kLargest)) throw program::ValueError("--force is '" + text + "', expected at most 1e6 N");
  return f;
}

query::Question questionOf(const Options& options) {
  if (options.level && std::isnan(*options.level))
    throw program::ValueError("--load-level is nan, expected 0 to 1");
  if (options.level) return {Parameters::kLevel, {*options.level, 0.0, 0.0}};
  if (options.force) return {Parameters::kForce, forceOf(*options.force)};
  if (!options.displacement) throw program::ValueError("--displacement or --force is empty, expected x,y,z");
  return {Parameters::kDisplacement, vectorOf("--displacement", *options.displacement)};
}

/// A displacement in metres. @throw program::ValueError where it is longer than any touch
query::Question checked(const MetaModel& model, query::Question question, const Options& options) {
  query::checkQuestion(model, question);
  if (question.prescribed != Parameters::kDisplacement) return question;
  const Vec3& d = question.value;
  question.value = query::displacementOf(model, asked("--displacement", {d[0], d[1], d[2]}, options));
  return question;
}

query::FullSolution solve(const MetaModel& model, const query::Organ& organ, const query::Anchor& anchor,
                          const query::Question& question, int steps) {
  const double a = model.attributes().patch_radius;
  if (question.prescribed == Parameters::kDisplacement)
    return query::solveFully(organ, anchor, a, question.value, steps);
  return query::solveUnderLoad(organ, anchor, a, query::forceOf(model, question), steps);
}

/// For the head of the deck.
std::string about(const Options& options) {
  if (options.level) return "load level " + std::to_string(*options.level);
  if (options.force) return "force " + *options.force + " N";
  return "patch displacement " + *options.displacement + " " + options.unit;
}

/// The tools of the question, none when it is about one.
std::vector<query::Touch> touchesOf(const MetaModel& model, const Options& options,
                                    const query::Anchor& anchor, const query::Question& question) {
  if (options.more_tools.empty()) return {};
  std::vector<query::Touch> touches{{anchor, question.value}};
  for (const std::string& text : options.more_tools) {
    query::Touch touch;
    program::orUsageError([&] { touch = query::parseTouch(model, "--tool2", text); });
    touch.d = query::displacementOf(model, asked("--tool2", {touch.d[0], touch.d[1], touch.d[2]}, options));
    touches.push_back(touch);
  }
  query::checkTouches(model, touches);
  return touches;
}

void warnInsideOut(const query::FullSolution* truth) {
  if (truth != nullptr && !(truth->min_det_f > 0.0))
    std::cerr << "palpate-query: Newton's solution turns elements inside out (min det F " << truth->min_det_f
              << "): not a state of the organ\n";
}

void warn(const query::Findings& found) {
  if (found.answer.status == ResponseStatus::kNoAnswer)
    std::cerr << "palpate-query: the point is not accessible: the model has no answer there\n";
  warnInsideOut(found.truth);
}

void writeFiles(const Options& options, const query::Findings& found) {
  if (!options.field.empty())
    program::writeFile(options.field, query::fieldVtu(found.model, found.answer, found.organ, found.truth));
  if (!options.deck.empty())
    program::writeFile(options.deck,
                       query::ccxDeck(*found.organ, *found.truth, about(options), options.steps));
}

/// The report about one tool, then that about all; the field is that of all.
void reportTogether(const Options& options, const query::Findings& first,
                    std::span<const query::Touch> touches) {
  const query::JointAnswer answer = query::askTogether(first.model, touches);
  std::optional<query::FullSolution> truth;
  if (first.truth != nullptr)
    truth = query::solveTogether(*first.organ, touches, first.model.attributes().patch_radius, options.steps);
  const query::JointFindings found{first.model, touches,     answer,
                                   first.organ, first.truth, truth ? &*truth : nullptr};
  warnInsideOut(found.truth);
  query::Answer shown = answer.tools.front().together;
  shown.field = answer.field;
  writeFiles(options, {first.model, first.anchor, first.question, shown, first.organ, found.truth});
  if (!options.json) {
    std::cout << query::toText(first) << query::toText(found);
    return;
  }
  program::Json json = query::toJson(first);
  json["two_tools"] = query::toJson(found);
  std::cout << json.dump(2, program::Keys::kAsWritten) << '\n';
}

/// @throw program::UsageError where --tool2 does not read, or does not go with the other options
void checkMoreTools(const Options& options) {
  if (options.more_tools.empty()) return;
  for (const std::string& text : options.more_tools) (void)query::parseNodeAndVector("--tool2", text);
  if (!options.displacement)
    throw program::UsageError(
        "--tool2 moves tools by displacements, expected --displacement for the first one too");
  if (!options.deck.empty())
    throw program::UsageError("--ccx writes a deck of one tool, expected no --tool2");
}

/// @throw program::UsageError where options do not go together
void checkOptions(const Options& options) {
  program::checkOutput("--field", options.field);
  program::checkOutput("--ccx", options.deck);
  const bool what = options.displacement || options.force || options.level;
  if (options.batch.empty()) {
    if (!what)
      throw program::UsageError("one of --displacement,--force,--load-level is required, or --batch");
    if (!options.output.empty()) throw program::UsageError("-o goes with --batch");
    if (!options.node) (void)program::parseVector("--at", options.at);
    return checkMoreTools(options);
  }
  if (what || options.newton || options.json || !options.more_tools.empty() || !options.deck.empty() ||
      !options.field.empty())
    throw program::UsageError("--batch goes with --unit and -o only");
  if (options.output.empty()) return;
  program::checkOutput("-o", options.output);
  if (program::isSameFile(options.batch, options.output))
    throw program::UsageError("-o " + options.output + " would replace the touches");
}

void runBatch(const Options& options) {
  const std::vector<query::TouchRow> touches =
      query::readTouches(options.batch, program::lengthUnit(options.unit));
  const MetaModel model = MetaModel::load(options.model);
  const std::string text = query::batchText(query::answersTo(model, touches));
  if (options.output.empty())
    std::cout << text;
  else
    program::writeFile(options.output, text);
}

void run(const Options& options) {
  checkOptions(options);
  if (!options.batch.empty()) return runBatch(options);
  // 1. The question.
  const query::Question asked_for = questionOf(options);
  const MetaModel model = MetaModel::load(options.model);
  const query::Question question = checked(model, asked_for, options);
  const query::Anchor anchor = anchorOf(model, options);
  const std::vector<query::Touch> touches = touchesOf(model, options, anchor, question);
  // 2. The model's answer.
  const query::Answer answer = query::ask(model, anchor, question);
  // 3. The truth.
  std::optional<query::Organ> organ;
  std::optional<query::FullSolution> truth;
  if (options.newton || !options.deck.empty()) {
    organ.emplace(query::organOf(model, modelfile::readVolumeMesh(options.model)));
    truth = solve(model, *organ, anchor, question, options.steps);
  }
  // 4. Files, then the report.
  const query::Findings found{
      model, anchor, question, answer, organ ? &*organ : nullptr, truth ? &*truth : nullptr};
  warn(found);
  if (!touches.empty()) return reportTogether(options, found, touches);
  writeFiles(options, found);
  std::cout << (options.json ? query::toJson(found).dump(2, program::Keys::kAsWritten) + "\n"
                             : query::toText(found));
}

int body(int argc, char** argv) {
  program::CommandLine line(
      "palpate-query", "Asks a model for the answer to one touch: force, stiffness, surface displacement.");
  Options options;
  describe(line.options(), options);
  line.footer(
      "--batch reads comma-separated touches. Its first line names the columns, in any order:\n"
      "  at_x,at_y,at_z,displacement_x,displacement_y,displacement_z\n"
      "The answers have the same lines in the same order, with the columns\n  " +
      query::batchColumns() +
      "\nThe first six are as asked for, in --unit. distance_m is from the place to the surface, negative "
      "inside; used_* is the\n"
      "displacement that the answer belongs to; clamped says whether it is shorter than what was asked for.\n"
      "A line that cannot be read or lies off the organ is named, and nothing is written.\n\n"
      "Example: palpate-query liver.h5 --at 20,0,60 --displacement 0,0,-2 --unit mm --newton");
  if (!line.read(argc, argv)) return program::kDone;
  run(options);
  return program::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return program::runProgram("palpate-query", &body, argc, argv);
}
