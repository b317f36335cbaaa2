// SPDX-License-Identifier: Apache-2.0
// palpate-certify: how far a model is off, found by fresh touches that full Newton solves, and written into its file.
//
// Sample runs:  palpate-certify liver.h5
//               palpate-certify liver.h5 --samples 59 --json --plot errors.svg
//               palpate-certify liver.h5 --report liver_report --youngs-modulus-error 0.2
//               palpate-certify liver.h5 --seed 7 --samples 100 --json    # measures only
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>

#include "core/data/model_view.h"
#include "tools/examine/certify/certificate.h"
#include "tools/examine/certify/certify_error.h"
#include "tools/examine/certify/error_plot.h"
#include "tools/examine/certify/examination.h"
#include "tools/examine/certify/pair_examination.h"
#include "tools/examine/certify/quantile_bound.h"
#include "tools/examine/certify/report/report.h"
#include "tools/modelfile/write_certificate.h"
#include "tools/program/certificate_line.h"
#include "tools/program/command_line.h"
#include "tools/program/printed.h"
#include "tools/program/run.h"
#include "tools/program/write_file.h"
#include "tools/solver/base/parallel.h"

namespace palpate::certify {
namespace {

struct Options {
  std::string model, plot, report;
  int samples{kSamples}, threads{solver::machineThreads()};
  std::optional<double> travel, length, modulus_error;
  std::optional<std::int64_t> seed;
  bool two_tools{false}, inward{false}, json{false}, no_write{false};

  /// What is drawn otherwise than a certificate's touches is a measurement only.
  [[nodiscard]] bool measures() const { return seed || inward || length; }
  [[nodiscard]] bool mayWrite() const {
    return !measures() && !no_write && samples >= static_cast<int>(kLeastSamples);
  }
};

void describe(program::Options line, Options& options) {
  line.add("model", &options.model, "model file (.h5), driven by displacement").required();
  line.add("--samples", &options.samples,
           "touches within the domain (default: 181); a bound takes 59, fewer are not written")
      .range(1, 100000);
  line.add("--travel", &options.travel,
           "how far tools press (default: the case's, else 0.007 below 50 kPa, 0.005 above)")
      .range(kShortestTravel, kLongestTravel, "m");
  line.flag("--two-tools", &options.two_tools,
            "certify pairs of tools too, 1.5 to 8 patch radii apart: twice as many");
  line.add("--plot", &options.plot, "draw the errors over the length of d (.svg)");
  line.add("--report", &options.report, "folder for report.html and report.json: what the model is good for");
  line.add("--youngs-modulus-error", &options.modulus_error,
           "with --report: how well E is known, relative, such as 0.2; a band on its force curves; default: "
           "no band")
      .range(0.0, 1.0);
  line.flag("--no-write", &options.no_write, "leave the file as it is");
  line.flag("--json", &options.json, "print one JSON object on standard output");
  line.add("--threads", &options.threads, "worker threads").range(1, 1024);
  line.add("--seed", &options.seed,
           "draw other touches than those of the content's digest; writes no certificate");
  line.flag("--inward", &options.inward,
            "draw only directions against the outward normal; writes no certificate");
  line.add("--length", &options.length, "length of all touches; writes no certificate")
      .range(kShortestTravel, kLongestTravel, "m");
  line.example("palpate-certify liver.h5 --report liver_report");
}

void checkKind(const MetaModel& model, const std::string& path) {
  if (!model.isDisplacementDriven())
    throw CertifyError(path + " is driven by " + std::string(toString(model.attributes().parameters)) +
                       "; certify takes displacement models");
}

Drawing drawingOf(const MetaModel& model, const Options& options) {
  const Travel travel = travelOf(model.attributes(), options.travel);
  return {travel,
          {travel.length, options.length, options.inward},
          options.seed ? static_cast<std::uint64_t>(*options.seed) : seedOf(model)};
}

/// Before the hours that an examination may take. @throw program::UsageError
void checkOptions(const Options& options) {
  if (options.seed && *options.seed < 0)
    throw program::UsageError("--seed is " + std::to_string(*options.seed) + ", expected 0 or more");
  if (options.modulus_error && options.report.empty())
    throw program::UsageError("--youngs-modulus-error goes with --report: it is a band on its force curves");
  if (!options.plot.empty() && program::isSameFile(options.plot, options.model))
    throw program::UsageError("--plot is the model itself, " + options.plot + ": expected another file");
  program::checkOutput("--plot", options.plot);
}

/// Before an examination that a missing pair would lose. @param touches  a copy: what it draws is drawn again
void checkPairs(const MetaModel& model, TouchSampler touches) {
  const double a = model.attributes().patch_radius;
  (void)touches.nextPair(kNearestPair * a, kFarthestPair * a);
}

/// Why nothing is written; empty: it is.
std::string reasonNotToWrite(const Options& options, const Examination& found) {
  if (options.measures()) return "a measurement, not a certificate";
  if (options.no_write) return "--no-write";
  if (!rankOfBound(found.count(Outcome::kWithin)))
    return "a certificate takes " + std::to_string(kLeastSamples) + " samples";
  return {};
}

/// Certified, or why not, in one line.
std::string statusOf(const Options& options, const std::string& certificate) {
  return options.measures() ? "measured, not a certificate: other touches than a certificate's"
                            : program::certificateLine(certificate);
}

/// Whether the file has it now. @param reason  of reasonNotToWrite()
std::string writtenText(const Options& options, const std::string& reason) {
  return reason.empty() ? "written into " + options.model
                        : "not written into " + options.model + " (" + reason + ")";
}

/// Nothing where none is asked for. @throw program::WriteError, CertifyError
std::optional<ReportFolder> reportFolderOf(const Options& options) {
  if (options.report.empty()) return {};
  return ReportFolder(options.report);
}

void writePlot(const Options& options, const Examination& found) {
  program::SvgPlot plot = errorPlot(found.findings);
  plot.title =
      "Errors of " + std::filesystem::path(options.model).filename().string() + " against full Newton";
  program::writeFile(options.plot, plot.render());
}

/// The object of --json; keys in docs/json.md. @param answer  the certificate
program::Json answerOf(program::Json answer, const Options& options, const MetaModel& model,
                       const Drawing& drawing, const Examination& found, bool written, double seconds) {
  answer["model"] = options.model;
  answer["model_id"] = model.id();
  answer["travel_from"] = drawing.travel.from;
  answer["inward"] = options.inward;
  answer["length"] = options.length ? program::Json(*options.length) : program::Json(nullptr);
  answer["written"] = written;
  answer["seconds"] = seconds;
  answer["touches"] = touchesOf(found);
  return answer;
}

void examineModel(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  // 1. The model, and the organ that it was made from.
  checkOptions(options);
  const MetaModel model = MetaModel::load(options.model);
  checkKind(model, options.model);
  const query::Organ organ = query::organOf(model, modelfile::readVolumeMesh(options.model));
  if (options.mayWrite()) program::checkWritable(std::filesystem::canonical(options.model));
  const std::optional<ReportFolder> report = reportFolderOf(options);
  // 2. Touches that no fit has seen, each beside its full solution.
  const Drawing drawing = drawingOf(model, options);
  TouchSampler touches(model, drawing.range, drawing.seed);
  if (options.two_tools) checkPairs(model, touches);
  const Extent extent{static_cast<std::size_t>(options.samples), std::min(options.threads, options.samples)};
  const Examination found = examine(model, organ, touches, drawing.travel.length, extent);
  // 3. What that says, in the file and as a picture.
  program::Json certificate = certificateOf(model, drawing, found);
  if (options.two_tools)
    certificate["two_tools"] =
        pairsOf(model, examinePairs(model, organ, touches, drawing.travel.length, extent));
  const std::string text = certificate.dump();
  const std::string not_written = reasonNotToWrite(options, found);
  if (not_written.empty()) modelfile::writeCertificate(options.model, text, model.digest());
  if (!options.plot.empty()) writePlot(options, found);
  if (report)
    writeReport(*report, {options.model, model, organ, drawing, found, certificate},
                statusOf(options, text) + "; " + writtenText(options, not_written), options.modulus_error,
                extent.threads);
  // 4. The answer.
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (options.json) {
    const program::Json answer =
        answerOf(certificate, options, model, drawing, found, not_written.empty(), seconds);
    std::cout << answer.dump(2, program::Keys::kAsWritten) << '\n';
    return;
  }
  std::cout << toText(certificate, drawing) << statusOf(options, text) << '\n'
            << writtenText(options, not_written) << program::printed(", %.1f s\n", seconds);
}

/// What a part that knows no file has to say gets the file's name.
void run(const Options& options) {
  const auto named = [&](const std::exception& error) {
    const std::string text = error.what();
    const bool complete = text.rfind("--", 0) == 0 || text.find(options.model) != std::string::npos;
    return complete ? text : options.model + ": " + text;
  };
  try {
    examineModel(options);
  } catch (const program::UsageError&) {
    throw;
  } catch (const program::WriteError&) {
    throw;  // names what it is about
  } catch (const std::runtime_error& error) {
    throw CertifyError(named(error));
  }
}

int body(int argc, char** argv) {
  program::CommandLine line(
      "palpate-certify",
      "Certifies a model: its errors against full nonlinear solutions of fresh random touches.");
  Options options;
  describe(line.options(), options);
  if (!line.read(argc, argv)) return program::kDone;
  run(options);
  return program::kDone;
}

}  // namespace
}  // namespace palpate::certify

int main(int argc, char** argv) {
  return palpate::program::runProgram("palpate-certify", &palpate::certify::body, argc, argv);
}
