// SPDX-License-Identifier: Apache-2.0
// The liver of Section 4.3: separated solutions over the whole boundary against full Newton, pair by pair.
#include "tools/examine/reproduce/liver_study.h"

#include <algorithm>

#include "core/base/index.h"
#include "tools/examine/reproduce/figures.h"
#include "tools/examine/reproduce/liver_linear.h"
#include "tools/examine/reproduce/liver_nonlinear.h"
#include "tools/examine/reproduce/liver_organ.h"
#include "tools/examine/reproduce/liver_ten_terms.h"
#include "tools/make/organ/paper_liver.h"
#include "tools/mesh/checks.h"
#include "tools/mesh/mesh_error.h"
#include "tools/mesh/read_mesh.h"

namespace palpate::reproduce {

namespace {

constexpr double kTravel =
    2e-3;  // m, median of |d| under the vertical load, most of |d| at held-out points; linear

mesh::TetMesh readOrgan(const std::filesystem::path& path) {
  mesh::TetMesh organ = mesh::readMesh(path);
  try {
    mesh::checkMesh(organ);
    if (organ.groups.count("fixed") == 0)
      throw mesh::MeshError("has no group \"fixed\" (palpate-organ import --fixed makes one)");
    mesh::checkHeld(organ, "fixed");
  } catch (const mesh::MeshError& error) {
    throw mesh::MeshError(path.string() + ": " + error.what());
  }
  return organ;
}

Json problemOf(const LiverOptions& options, const solver::SolverSetup& setup, double load) {
  const std::string mesh = options.mesh.empty() ? "The paper's liver" : options.mesh.filename().string();
  return {{"mesh", mesh},
          {"nodes", setup.model.nodeCount()},
          {"tetrahedra", setup.model.elementCount()},
          {"surface_nodes", setup.surface.nodes.size()},
          {"fixed_nodes", setup.model.fixedNodes().size()},
          {"positions_count", setup.positions.nodes.size()},
          {"E_kPa", 1e-3 * setup.model.material().elasticity.E},
          {"nu", setup.model.material().elasticity.nu},
          {"patch_radius_mm", 1e3 * setup.patch_radius},
          {"load_N", load},
          {"travel_mm", 1e3 * kTravel},
          {"samples", options.samples}};
}

SurfacePanel panelOf(const solver::SolverSetup& setup, const std::string& title, std::vector<double> values) {
  return {title, setup.surface.positions, setup.surface.triangles, std::move(values)};
}

SurfaceFigure figureOf(const std::string& title, std::vector<SurfacePanel> panels) {
  SurfaceFigure figure;
  figure.title = title;
  figure.panels = std::move(panels);
  figure.elevation = 65;
  figure.azimuth = 25;
  figure.zoom = 2.2;
  return figure;
}

/// One row per surface node; missing functions are zero.
std::vector<std::vector<double>> functionRows(const std::vector<SurfacePanel>& X,
                                              const std::vector<SurfacePanel>& Y) {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < X.front().positions.size(); ++i) {
    const Eigen::Vector3d& x = X.front().positions[i];
    std::vector<double> row{x.x(), x.y(), x.z()};
    for (const std::vector<SurfacePanel>* panels : {&X, &Y})
      for (std::size_t k = 0; k < 6; ++k) row.push_back(k < panels->size() ? (*panels)[k].values[i] : 0.0);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Linear between contact positions: nodes in the middle of edges get the mean of the ends.
void fillMidsides(const solver::PatchSurface& surface, std::vector<double>& values) {
  if (surface.faces.size() == surface.triangles.size()) return;
  for (std::size_t t = 0; t < surface.faces.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)  // the fourth of a face's triangles has them
      values[index(surface.triangles[4 * t + 3][k])] =
          0.5 * (values[index(surface.faces[t][(k + 1) % 3])] + values[index(surface.faces[t][(k + 2) % 3])]);
}

/// Third component of the first six X_k on the boundary, and the first six Y_k.
void writeFunctions(const solver::SolverSetup& setup, const solver::ScalarPairs& pairs, Output& out) {
  std::vector<SurfacePanel> X, Y;
  for (Eigen::Index k = 0; k < std::min<Eigen::Index>(6, pairs.X.cols()); ++k) {
    std::vector<double> x(setup.surface.nodes.size(), 0.0), y(setup.surface.nodes.size(), 0.0);
    for (std::size_t i = 0; i < x.size(); ++i)
      if (setup.model.isFree(setup.surface.nodes[i]))
        x[i] = pairs.X(setup.model.dof(setup.surface.nodes[i]) + 2, k);
    for (std::size_t p = 0; p < setup.positions.nodes.size(); ++p)
      y[index(setup.positions.nodes[p])] = pairs.Y(k, static_cast<Eigen::Index>(p));
    fillMidsides(setup.surface, y);
    X.push_back(panelOf(setup, "X_{3}^{" + std::to_string(k + 1) + "}(x)", std::move(x)));
    Y.push_back(panelOf(setup, "Y^{" + std::to_string(k + 1) + "}(s)", std::move(y)));
  }
  out.writeCsv("figures-6-7-liver.csv",
               {"x_m", "y_m", "z_m", "X1", "X2", "X3", "X4", "X5", "X6", "Y1", "Y2", "Y3", "Y4", "Y5", "Y6"},
               functionRows(X, Y));
  drawSurfaces(out.file("figure-6-liver-x.png"),
               figureOf("Liver: first six X (paper: Figure 6)", std::move(X)));
  drawSurfaces(out.file("figure-7-liver-y.png"),
               figureOf("Liver: first six Y (paper: Figure 7)", std::move(Y)));
}

void writeErrors(const Json& results, Output& out) {
  Chart chart{"Liver: error against full Newton at held-out points, 95 %",
              "pairs",
              "relative to the contact displacement",
              false,
              true,
              {}};
  const std::pair<const char*, const char*> names[] = {
      {"field_error_p95", "field"},
      {"svd_field_error_p95", "field, best separation (SVD)"},
      {"contact_error_p95", "contact displacement"},
      {"force_error_p95", "force"}};
  std::vector<std::vector<double>> rows;
  for (const Json& row : results["modes_table"])
    rows.push_back(numbersOf(row, {"pairs", "field_error_p95", "svd_field_error_p95", "contact_error_p95",
                                   "contact_error_max", "force_error_p95"}));
  for (const auto& [key, name] : names) {
    Curve curve{name, {}};
    for (const Json& row : results["modes_table"])
      curve.points.emplace_back(row["pairs"].get<double>(), row[key].get<double>());
    chart.curves.push_back(curve);
  }
  for (const auto& [key, name] : {std::pair{"field_error_p95", "field, three-part model"},
                                  {"contact_error_p95", "contact, three-part model"}}) {
    Curve curve{name, {}, true, false};
    for (const Json& row : results["modes_table"])
      curve.points.emplace_back(row["pairs"].get<double>(), results["three_part"][key].get<double>());
    chart.curves.push_back(curve);
  }
  out.writeCsv("figure-liver-errors.csv",
               {"pairs", "field_error_p95", "svd_field_error_p95", "contact_error_p95", "contact_error_max",
                "force_error_p95"},
               rows);
  drawChart(out.file("figure-liver-errors.svg"), chart);
}

}  // namespace

Json reproduceLiver(const LiverOptions& asked, Output& out) {
  const double start = now();
  LiverOptions options = asked;
  std::sort(options.pairs.begin(), options.pairs.end());
  out.step("the organ, its clamp and its load positions");
  const mesh::TetMesh mesh =
      options.mesh.empty() ? organ::makePaperLiver(options.element_size) : readOrgan(options.mesh);
  const solver::Case c = wholeBoundary(options.mesh);
  const solver::SolverSetup setup(c, mesh);
  if (options.pairs.back() >= static_cast<int>(setup.positions.nodes.size()))
    throw ReproduceError("--pairs " + std::to_string(options.pairs.back()) + ": the organ has only " +
                         std::to_string(setup.positions.nodes.size()) + " load positions");
  double load = 0.0;
  const solver::BodyProblem problem = downwardProblem(setup, kTravel, load);
  Json results = problemOf(options, setup, load);
  std::vector<Touch> touches = drawPoints(setup, options.samples, 2013);
  const solver::ScalarPairs pairs = studyLinear(setup, problem, touches, options, out, results);
  drawLoads(setup.model, solver::Cholesky(problem.stiffness()), kTravel, 586, touches);
  studyNonlinear({c, mesh, setup, options}, touches, out, results);
  studyTenTerms(options, out, results);
  out.step("Figures 5 to 7");
  SurfaceFigure model = figureOf("Liver: the mesh (paper: Figure 5)", {panelOf(setup, "", {})});
  drawSurfaces(out.file("figure-5-liver-model.png"), model);
  writeFunctions(setup, pairs, out);
  writeErrors(results, out);
  results["seconds"] = now() - start;
  return results;
}

}  // namespace palpate::reproduce
