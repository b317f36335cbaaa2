// SPDX-License-Identifier: Apache-2.0
#include "liver_nonlinear.h"

#include <algorithm>
#include <string>

#include "palpate/core/response.h"
#include "palpate/modelfile/model_file.h"
#include "palpate/offline/build_model.h"
#include "palpate/offline/store_modes.h"

namespace palpate::reproduce {

namespace {

constexpr int kOversampling = 60;     // modes beyond those asked for, and
constexpr int kConvergedSweeps = 12;  // sweeps after which the fit no longer moves: the SVD

modelfile::ModelData solve(const LiverStudy& study, offline::Method method, int modes, int sweeps,
                           const Output& out) {
  offline::Case c = study.solve;
  c.method = method;
  if (modes > 0) c.modes = modes;
  if (sweeps > 0) c.sweeps = sweeps;
  offline::BuildReport report;
  modelfile::ModelData data = offline::buildModel(
      c, study.mesh, {study.options.workers, std::filesystem::absolute(out.file("")), out.quiet()}, report);
  data.attributes.provenance = Json{{"program", "palpate-reproduce"}}.dump();
  data.attributes.model_id = "reproduce";
  return data;
}

/// The first n pairs of a "force" model, its contact displacement what they give.
modelfile::ModelData cut(const offline::SolverSetup& setup, const modelfile::ModelData& data,
                         Eigen::Index n) {
  const auto rows = static_cast<Eigen::Index>(3 * setup.surface.nodes.size());
  const auto all = static_cast<Eigen::Index>(data.modes_X.size()) / rows;
  const auto columns = static_cast<Eigen::Index>(data.modes_Y.size()) / all;
  const Eigen::Map<const Eigen::MatrixXf> X(data.modes_X.data(), rows, all),
      Y(data.modes_Y.data(), all, columns);
  modelfile::ModelData out = data;
  out.near_offset.clear();
  offline::storeModes(setup, X.leftCols(n), Y.topRows(n), out);
  return out;
}

MetaModel writeAndLoad(const std::filesystem::path& path, const modelfile::ModelData& data) {
  modelfile::writeModel(path, data);
  return MetaModel::load(path);
}

double MiB(const std::filesystem::path& path) {
  return double(std::filesystem::file_size(path)) / 1048576.0;
}

/// Median time of the whole surface from one touch.
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

/// The one of the numbers of pairs that the paper has, or the nearest.
int papersPairs(const std::vector<int>& pairs) {
  constexpr int kPaper = 167;
  return *std::min_element(pairs.begin(), pairs.end(),
                           [](int a, int b) { return std::abs(a - kPaper) < std::abs(b - kPaper); });
}

}  // namespace

void studyNonlinear(const LiverStudy& study, std::vector<Touch>& touches, Output& out, Json& results) {
  const std::vector<int>& pairs = study.options.pairs;
  const int most = *std::max_element(pairs.begin(), pairs.end());
  const std::filesystem::path scratch = out.file("liver.tmp.h5");
  out.step("series in the force, compressed to " + std::to_string(most) + " pairs");
  double start = now();
  const modelfile::ModelData series = solve(study, offline::Method::kSeriesForce, most, 0, out);
  results["series_seconds"] = now() - start;
  results["order"] = series.attributes.order;
  out.step("the best separation of the same series: its SVD");
  const modelfile::ModelData best =
      solve(study, offline::Method::kSeriesForce, most + kOversampling, kConvergedSweeps, out);
  out.step("full Newton at " + std::to_string(touches.size()) + " held-out points");
  limitLoads(writeAndLoad(scratch, series), touches);
  solveTouches(study.setup, study.options.workers, out.quiet(), touches);
  out.step("errors for every number of pairs");
  const int papers = papersPairs(pairs);
  for (const int n : pairs) {
    const bool keep = n == papers;
    const std::filesystem::path path = keep ? out.file("liver-" + std::to_string(n) + "-pairs.h5") : scratch;
    const MetaModel model = writeAndLoad(path, cut(study.setup, series, n));
    Json row{{"pairs", n}};
    row.update(quantiles(errorsOf(model, touches)));
    if (keep) timeEvaluation(model, touches.front(), results);
    if (keep) results["model_MiB"] = MiB(path);
    const MetaModel optimum = writeAndLoad(scratch, cut(study.setup, best, n));
    const std::vector<TouchError> errors = errorsOf(optimum, touches);
    row["svd_field_error_p95"] = quantile(errors, &TouchError::field, 0.95);
    row["svd_contact_error_p95"] = quantile(errors, &TouchError::contact, 0.95);
    results["modes_table"].push_back(row);
  }
  std::filesystem::remove(scratch);
  out.step("palpate's three-part model");
  start = now();
  const std::filesystem::path path = out.file("liver-three-part.h5");
  const MetaModel model = writeAndLoad(path, solve(study, offline::Method::kSeriesDisplacement, 0, 0, out));
  results["three_part"] = quantiles(errorsOf(model, touches));
  results["three_part"]["modes"] = model.view().modes();
  results["three_part"]["MiB"] = MiB(path);
  results["three_part"]["seconds"] = now() - start;
}

}  // namespace palpate::reproduce
