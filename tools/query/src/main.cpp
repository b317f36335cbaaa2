// SPDX-License-Identifier: Apache-2.0
// palpate-query: asks a model what one touch would feel like, and checks it against the full solution.
//
// Sample runs:  palpate-query liver.h5 --node 1204 --displacement 0,0,-0.002
//               palpate-query liver.h5 --at 0.05,0.01,0.06 --displacement -0.001,0,-0.002 --newton --json
//               palpate-query liver.h5 --node 1204 --displacement 0,0,-0.002 --ccx deck.inp --field touch.vtu
//               palpate-query force.h5 --node 1204 --force 0,0,-0.5 --newton
//               palpate-query liver.h5 --node 1204 --displacement 0,0,-0.002 --tool2 87:0,0,-0.002 --newton
//               palpate-query level.h5 --node 1204 --load-level 0.75 --newton
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <optional>
#include <span>

#include "palpate/query/arguments.h"
#include "palpate/query/ccx_deck.h"
#include "palpate/query/field_file.h"
#include "palpate/query/query_error.h"
#include "report.h"
#include "report_together.h"

namespace {

using namespace palpate;

struct Options {
  std::string model, at;
  std::optional<std::string> displacement, force;
  std::optional<std::int64_t> node;
  std::optional<double> level;
  std::vector<std::string> more_tools;
  std::string deck, field;
  int steps{1};
  bool newton{false};
  bool json{false};
};

void describe(CLI::App& app, Options& options) {
  app.set_version_flag("--version", PALPATE_VERSION);
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return std::string("palpate-query: ") + error.what() + " (--help tells more)\n";
  });
  app.add_option("model", options.model, "model file (.h5)")->required();
  CLI::Option_group* const where = app.add_option_group("where");
  where->add_option("--node", options.node, "touch this surface node, by its number in the mesh file");
  where->add_option("--at", options.at, "touch the surface point nearest to x,y,z, m");
  where->require_option(1);
  CLI::Option_group* const what = app.add_option_group("what");
  what->add_option("--displacement", options.displacement, "displacement dx,dy,dz of the contact patch, m");
  what->add_option("--force", options.force, "force fx,fy,fz of the tool, N (models driven by force)");
  what->add_option("--load-level", options.level, "part of the model's load, 0 to 1 (models driven by level)")
      ->check(CLI::Range(0.0, 1.0));
  what->require_option(1);
  app.add_option("--tool2", options.more_tools,
                 "another tool at the same time: NODE:dx,dy,dz, m; goes with --displacement, may be repeated")
      ->allow_extra_args(false);
  app.add_flag("--newton", options.newton, "solve the full problem too, and tell how far the model is off");
  app.add_option("--steps", options.steps, "load steps of the full solution to begin with")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--ccx", options.deck, "write the full problem as a CalculiX deck (implies --newton)");
  app.add_option("--field", options.field, "write the surface displacement as VTK (.vtu)");
  app.add_flag("--json", options.json, "print one JSON object on standard output");
}

/// The command line without the program's name, last word first as CLI11 takes it.
std::vector<std::string> reversedWords(int argc, char** argv) {
  static constexpr std::array<const char*, 4> kVectors{"--at", "--displacement", "--force", "--tool2"};
  const std::vector<const char*> words(argv + std::min(argc, 1), argv + argc);
  std::vector<std::string> joined = query::joinVectors(words, kVectors);
  std::reverse(joined.begin(), joined.end());
  return joined;
}

query::Anchor anchorOf(const MetaModel& model, const Options& options) {
  return options.node ? query::anchorAtNode(model, *options.node)
                      : query::anchorNear(model, query::parseVector("--at", options.at));
}

query::Question questionOf(const Options& options) {
  if (options.level && std::isnan(*options.level))
    throw query::QueryError("--load-level is nan, expected 0 to 1");
  if (options.level) return {Parameters::kLevel, {*options.level, 0.0, 0.0}};
  if (options.force) return {Parameters::kForce, query::parseVector("--force", *options.force)};
  if (!options.displacement) throw query::QueryError("--displacement or --force is empty, expected x,y,z");
  return {Parameters::kDisplacement, query::parseVector("--displacement", *options.displacement)};
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
  return "patch displacement " + *options.displacement + " m";
}

/// The tools of the question, none when it is about one.
std::vector<query::Touch> touchesOf(const MetaModel& model, const Options& options,
                                    const query::Anchor& anchor, const query::Question& question) {
  if (options.more_tools.empty()) return {};
  if (question.prescribed != Parameters::kDisplacement)
    throw query::QueryError(
        "--tool2 moves tools by displacements, expected --displacement for the first one too");
  if (!options.deck.empty()) throw query::QueryError("--ccx writes a deck of one tool, expected no --tool2");
  std::vector<query::Touch> touches{{anchor, question.value}};
  for (const std::string& text : options.more_tools)
    touches.push_back(query::parseTouch(model, "--tool2", text));
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
    query::writeText(options.field, query::fieldVtu(found.model, found.answer, found.organ, found.truth));
  if (!options.deck.empty())
    query::writeText(options.deck, query::ccxDeck(*found.organ, *found.truth, about(options), options.steps));
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
  nlohmann::ordered_json json = query::toJson(first);
  json["two_tools"] = query::toJson(found);
  std::cout << json.dump(2) << '\n';
}

void run(const Options& options) {
  // 1. The question.
  const query::Question question = questionOf(options);
  const MetaModel model = MetaModel::load(options.model);
  query::checkQuestion(model, question);
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
  std::cout << (options.json ? query::toJson(found).dump(2) + "\n" : query::toText(found));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Asks a model for the answer to one touch: force, stiffness, surface displacement.",
               "palpate-query");
  Options options;
  describe(app, options);
  try {
    app.parse(reversedWords(argc, argv));
    run(options);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    std::cerr << "palpate-query: " << error.what() << '\n';
    return 1;
  }
  return std::cout.flush() ? 0 : 1;
}
