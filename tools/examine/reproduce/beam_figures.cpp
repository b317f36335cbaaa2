// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/reproduce/beam_figures.h"

#include <string>
#include <utility>

#include "tools/examine/reproduce/figures.h"

namespace palpate::reproduce {

namespace {

using Eigen::VectorXd;

void writeCurve(const Json& results, Output& out) {
  Chart chart{"Beam: tip displacement, load at the tip", "load level", "mm", false, false, {}};
  const std::pair<const char*, const char*> names[] = {{"newton_mm", "full Newton"},
                                                       {"ten_term_mm", "ten terms, separated"},
                                                       {"forward_euler_mm", "forward Euler, separated"},
                                                       {"linear_mm", "linear"}};
  std::vector<std::vector<double>> rows;
  for (const Json& row : results["load_curve"])
    rows.push_back(numbersOf(
        row, {"level", "newton_mm", "ten_term_mm", "forward_euler_mm", "linear_mm", "ten_term_l2_error"}));
  for (const auto& [key, name] : names) {
    Curve curve{name, {{0.0, 0.0}}};
    for (const Json& row : results["load_curve"])
      curve.points.emplace_back(row["level"].get<double>(), row[key].get<double>());
    curve.dashed = std::string(key) == "newton_mm";
    chart.curves.push_back(curve);
  }
  out.writeCsv("figure-beam-load.csv",
               {"level", "newton_mm", "ten_term_mm", "forward_euler_mm", "linear_mm", "ten_term_l2_error"},
               rows);
  drawChart(out.file("figure-beam-load.svg"), chart);
}

/// The deformed surface; colours are |u| in mm.
SurfacePanel deformed(const Beam& beam, const std::string& title, const VectorXd& unknowns) {
  const VectorXd u = beam.problem.toNodes(unknowns);
  SurfacePanel panel{title, beam.surface.positions, beam.surface.triangles, {}};
  for (std::size_t i = 0; i < panel.positions.size(); ++i) {
    const solver::Vec3 at = u.segment<3>(3 * beam.surface.nodes[i]);
    panel.positions[i] += at;
    panel.values.push_back(1e3 * at.norm());
  }
  return panel;
}

SurfaceFigure beamFigure(const std::string& title, std::vector<SurfacePanel> panels) {
  SurfaceFigure figure;
  figure.title = title;
  figure.panels = std::move(panels);
  figure.elevation = 72;
  figure.azimuth = 20;
  figure.columns = 2;
  figure.zoom = 2.0;
  figure.diverging = false;
  figure.colour_label = "|u| / mm";
  return figure;
}

/// Displacements of the surface nodes behind Figures 3 and 4.
void writeFields(const Beam& beam, const BeamSolutions& solutions, const Output& out) {
  const VectorXd fields[] = {beam.problem.toNodes(solutions.newton[static_cast<std::size_t>(beam.tip)]),
                             beam.problem.toNodes(solver::evaluate(solutions.ten_term, beam.tip, 1.0)),
                             beam.problem.toNodes(solver::evaluate(solutions.forward_euler, beam.tip, 1.0))};
  std::vector<std::vector<double>> rows;
  for (const std::int32_t node : beam.surface.nodes) {
    const solver::Vec3& x = beam.model.nodes()[static_cast<std::size_t>(node)];
    std::vector<double> row{x.x(), x.y(), x.z()};
    for (const VectorXd& u : fields)
      for (int c = 0; c < 3; ++c) row.push_back(u[3 * node + c]);
    rows.push_back(std::move(row));
  }
  out.writeCsv("figures-3-4-beam.csv",
               {"x_m", "y_m", "z_m", "newton_x", "newton_y", "newton_z", "ten_term_x", "ten_term_y",
                "ten_term_z", "forward_euler_x", "forward_euler_y", "forward_euler_z"},
               rows);
}

void writePictures(const Beam& beam, const BeamSolutions& solutions, Output& out) {
  SurfaceFigure model = beamFigure("Beam: the mesh (paper: Figure 2)",
                                   {{"", beam.surface.positions, beam.surface.triangles, {}}});
  model.colour_label.clear();
  drawSurfaces(out.file("figure-2-beam-model.png"), model);
  const SurfacePanel newton =
      deformed(beam, "full Newton", solutions.newton[static_cast<std::size_t>(beam.tip)]);
  drawSurfaces(
      out.file("figure-3-beam-deformed.png"),
      beamFigure("Beam: deformed by a load at the tip (paper: Figure 3)",
                 {deformed(beam, "ten terms, separated", solver::evaluate(solutions.ten_term, beam.tip, 1.0)),
                  newton}));
  drawSurfaces(out.file("figure-4-beam-forward-euler.png"),
               beamFigure("Beam: forward Euler as it comes out (paper: Figure 4)",
                          {deformed(beam, "forward Euler, separated",
                                    solver::evaluate(solutions.forward_euler, beam.tip, 1.0)),
                           newton}));
}

void writePositions(const Json& results, Output& out) {
  Chart errors{"Beam: error at every position of the load",
               "x of the load / mm",
               "relative L2 error of the field",
               false,
               true,
               {{"ten terms against full Newton", {}, false, true}}};
  std::vector<std::vector<double>> rows;
  for (const Json& p : results["positions"]) {
    errors.curves[0].points.emplace_back(p["x_mm"].get<double>(), p["l2_error"].get<double>());
    rows.push_back(numbersOf(p, {"node", "x_mm", "y_mm", "force_N", "newton_tip_mm", "l2_error"}));
  }
  errors.curves[0].lines = false;
  out.writeCsv("figure-beam-positions.csv", {"node", "x_mm", "y_mm", "force_N", "newton_tip_mm", "l2_error"},
               rows);
  drawChart(out.file("figure-beam-positions.svg"), errors);
}

}  // namespace

void writeFigures(const Beam& beam, const BeamSolutions& solutions, const Json& results, Output& out) {
  writeCurve(results, out);
  writePositions(results, out);
  writeFields(beam, solutions, out);
  writePictures(beam, solutions, out);
}

}  // namespace palpate::reproduce
