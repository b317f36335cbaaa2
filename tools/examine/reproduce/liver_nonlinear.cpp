// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/liver_nonlinear.h"

#include <algorithm>
#include <string>

#include "core/model/field_evaluation.h"
#include "core/response/patch_response.h"
#include "core/response/response.h"
#include "tools/modelfile/write_model.h"
#include "tools/solver/build/build_model.h"
#include "tools/solver/build/force_series.h"
#include "tools/solver/build/store_modes.h"

namespace palpate::reproduce {

namespace {

constexpr int kOversampling = 60;     // further modes of the best separation, and
constexpr int kConvergedSweeps = 12;  // sweeps after which the fit has converged to the SVD

solver::BuildOptions buildOptions(const LiverStudy& study, const Output& out) {
  return {study.options.workers, std::filesystem::absolute(out.file("")), out.quiet()};
}

/// u(X, s, f) for each number of pairs, fitted as palpate-solve does; last, the converged fit.
std::vector<modelfile::ModelData> solveForce(const LiverStudy& study, const Output& out) {
  solver::Case c = study.solve;
  c.method = solver::Method::kSeriesForce;
  std::vector<solver::FitSize> sizes;
  for (const int n : study.options.pairs) sizes.push_back({n, c.sweepsOrDefault()});
  sizes.push_back({study.options.pairs.back() + kOversampling, kConvergedSweeps});
  solver::BuildReport report;
  return solver::buildForceSeries(c, study.mesh, buildOptions(study, out), sizes, report);
}

modelfile::ModelData solveThreePart(const LiverStudy& study, const Output& out) {
  solver::BuildReport report;
  return solver::buildModel(study.solve, study.mesh, buildOptions(study, out), report);
}

/// The first n pairs of a "force" model, with the contact displacement of these pairs.
modelfile::ModelData cut(const solver::SolverSetup& setup, const modelfile::ModelData& data, Eigen::Index n) {
  const auto rows = static_cast<Eigen::Index>(3 * setup.surface.nodes.size());
  const auto all = static_cast<Eigen::Index>(data.modes_X.size()) / rows;
  const auto columns = static_cast<Eigen::Index>(data.modes_Y.size()) / all;
  const Eigen::Map<const Eigen::MatrixXf> X(data.modes_X.data(), rows, all),
      Y(data.modes_Y.data(), all, columns);
  modelfile::ModelData out = data;
  n = std::min(n, all);
  solver::storeModes(setup, X.leftCols(n), Y.topRows(n), out);
  return out;
}

/// @param id names the model among those of this run
MetaModel writeAndLoad(const std::filesystem::path& path, modelfile::ModelData data, const std::string& id) {
  data.attributes.provenance =
      Json{{"program", "palpate-reproduce"}, {"version", PALPATE_VERSION}, {"model", id}}.dump(
          -1, program::Keys::kAsWritten);
  modelfile::writeModel(path, data);
  return MetaModel::load(path);
}

double MiB(const std::filesystem::path& path) {
  return double(std::filesystem::file_size(path)) / 1048576.0;
}

/// Median time to evaluate the whole surface for one touch.
void timeEvaluation(const MetaModel& model, const Touch& touch, Json& results) {
  FieldScratch scratch(model);
  std::vector<float> u(3 * model.view().surfaceNodes());
  Response response;
  static_cast<void>(respondToLoad(model, touch.s, touch.force, response));
  const FieldSource source{touch.s, response.parameter, 1.0};
  std::vector<double> seconds;
  for (double start = now(); now() - start < 1.0;) {
    const double before = now();
    evaluateField(model, std::span(&source, 1), scratch, u);
    seconds.push_back(now() - before);
  }
  std::nth_element(seconds.begin(), seconds.begin() + std::ptrdiff_t(seconds.size() / 2), seconds.end());
  const double median = seconds[seconds.size() / 2];
  results["evaluation_us"] = 1e6 * median;
  results["evaluation_pairs"] = model.view().modes();
  results["evaluations_per_second"] = 1.0 / median;
}

Json quantiles(const std::vector<TouchError>& errors) {
  return {{"field_error_p95", quantile(errors, &TouchError::field, 0.95)},
          {"field_error_median", quantile(errors, &TouchError::field, 0.5)},
          {"contact_error_p95", quantile(errors, &TouchError::contact, 0.95)},
          {"contact_error_max", quantile(errors, &TouchError::contact, 1.0)},
          {"force_error_p95", quantile(errors, &TouchError::force, 0.95)}};
}

/// The number of pairs nearest to the paper's.
int papersPairs(const std::vector<int>& pairs) {
  constexpr int kPaper = 167;
  return *std::min_element(pairs.begin(), pairs.end(),
                           [](int a, int b) { return std::abs(a - kPaper) < std::abs(b - kPaper); });
}

/// Size of the loads, and how many were reduced to the series' domain.
void addLoads(const std::vector<Touch>& touches, int limited, Json& results) {
  std::vector<double> moved;
  for (const Touch& touch : touches) moved.push_back(1e3 * touch.displacement.norm());
  std::sort(moved.begin(), moved.end());
  results["loads"] = {
      {"limited", limited}, {"median_mm", moved[moved.size() / 2]}, {"largest_mm", moved.back()}};
}

Json rowOf(const LiverStudy& study, const modelfile::ModelData& data, const modelfile::ModelData& best,
           const std::vector<Touch>& touches, const Output& out, int n) {
  const std::filesystem::path scratch = out.file("liver.tmp.h5");
  Json row{{"pairs", n}};
  addAll(row, quantiles(errorsOf(writeAndLoad(scratch, data, "force"), touches)));
  const MetaModel optimum = writeAndLoad(scratch, cut(study.setup, best, n), "force-svd");
  const std::vector<TouchError> errors = errorsOf(optimum, touches);
  row["svd_field_error_p95"] = quantile(errors, &TouchError::field, 0.95);
  row["svd_contact_error_p95"] = quantile(errors, &TouchError::contact, 0.95);
  std::filesystem::remove(scratch);
  return row;
}

void evaluatePapersModel(const LiverStudy& study, const std::vector<modelfile::ModelData>& models,
                         const std::vector<Touch>& touches, const Output& out, Json& results) {
  const std::vector<int>& pairs = study.options.pairs;
  const int n = papersPairs(pairs);
  const auto i = static_cast<std::size_t>(std::find(pairs.begin(), pairs.end(), n) - pairs.begin());
  const std::filesystem::path path = out.file("liver-" + std::to_string(n) + "-pairs.h5");
  timeEvaluation(writeAndLoad(path, models[i], "force-" + std::to_string(n)), touches.front(), results);
  results["model_MiB"] = MiB(path);
}

}  // namespace

void studyNonlinear(const LiverStudy& study, std::vector<Touch>& touches, Output& out, Json& results) {
  out.step("series in the force, compressed to " + std::to_string(study.options.pairs.size()) +
           " numbers of pairs, and its best separation");
  double start = now();
  const std::vector<modelfile::ModelData> models = solveForce(study, out);
  results["series_seconds"] = now() - start;
  results["order"] = models.front().attributes.order;
  out.step("full Newton at " + std::to_string(touches.size()) + " held-out points");
  const std::filesystem::path scratch = out.file("liver.tmp.h5");
  const int limited = limitLoads(writeAndLoad(scratch, models.back(), "force-svd"), touches);
  solveTouches(study.setup, study.options.workers, out.quiet(), touches);
  addLoads(touches, limited, results);
  out.step("errors for every number of pairs");
  for (std::size_t i = 0; i < study.options.pairs.size(); ++i)
    results["modes_table"].push_back(
        rowOf(study, models[i], models.back(), touches, out, study.options.pairs[i]));
  evaluatePapersModel(study, models, touches, out, results);
  out.step("palpate's three-part model");
  start = now();
  const std::filesystem::path path = out.file("liver-three-part.h5");
  const MetaModel model = writeAndLoad(path, solveThreePart(study, out), "three-part");
  Json three_part = quantiles(errorsOf(model, touches));
  three_part["modes"] = model.view().modes();
  three_part["MiB"] = MiB(path);
  three_part["seconds"] = now() - start;
  results["three_part"] = three_part;
}

}  // namespace palpate::reproduce
