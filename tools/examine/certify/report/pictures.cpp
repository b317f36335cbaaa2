// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/report/pictures.h"

#include <algorithm>
#include <array>

#include "core/base/symmetric_eigen.h"
#include "tools/examine/certify/error_plot.h"
#include "tools/picture/surface_picture.h"
#include "tools/program/printed.h"
#include "tools/program/svg_plot.h"

namespace palpate::certify {

namespace {

using picture::SurfacePicture;
using program::Look;
using program::printed;
using Numbers = std::vector<std::optional<double>>;

constexpr double kWidth = 480;  // px, so that a phone shows it

std::string placeText(const Vec3& X) {
  return printed("(%.1f, %.1f, %.1f) mm", 1e3 * X[0], 1e3 * X[1], 1e3 * X[2]);
}

std::string directionText(const Vec3& e) {
  return printed("(%.2f, %.2f, %.2f)", e[0], e[1], e[2]);
}

/// Towards the eye: first from where the surface is accessible, along the organ's thinnest extent, then from behind.
std::array<Vec3, 2> sidesOf(const MetaModel& model) {
  const SurfaceMesh& surface = model.surface();
  Vec3 middle = Vec3::Zero(), outward = Vec3::Zero();
  const Eigen::Map<const Eigen::Matrix3Xd> X(model.view().surface_positions.data(), 3, surface.nodes());
  middle = X.rowwise().mean();
  const Mat3 spread = (X.colwise() - middle) * (X.colwise() - middle).transpose();
  for (std::int32_t t = 0; t < surface.triangles(); ++t) {
    const std::array<Vec3, 3> corners = surface.corners(t);
    if (surface.accessible(t)) outward += (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  }
  const Vec3 thin = symmetricEigen<Mat3>(spread).vectors.col(0);
  const Vec3 first = thin.dot(outward) < 0.0 ? Vec3(-thin) : thin;
  return {first, -first};
}

/// A picture from each side. @param about  what the numbers are  @param marks  what the marks are, or empty
std::vector<Figure> bothSides(const MetaModel& model, SurfacePicture picture, const std::string& about,
                              const std::string& marks = {}) {
  picture.surface.positions = model.view().surface_positions;
  picture.surface.triangles = model.view().surface_triangles;
  picture.width = kWidth;
  std::vector<Figure> figures;
  for (const Vec3& side : sidesOf(model)) {
    picture.surface.towards_eye = side;
    const std::string seen = about + ", seen from " + directionText(side);
    figures.push_back({picture.svg(), seen + ". " + picture.bar_label + ".", seen + '.' + marks});
  }
  return figures;
}

Numbers scaled(const Numbers& numbers, double factor) {
  Numbers list;
  for (const auto& number : numbers) list.push_back(number ? std::optional(factor * *number) : std::nullopt);
  return list;
}

/// A map over the surface with a cross at its largest or its smallest number.
std::vector<Figure> mapOf(const ReportInput& input, const Numbers& numbers, bool largest, const char* unit,
                          const std::string& about) {
  SurfacePicture picture;
  picture.bar_label = unit;
  picture.surface.numbers = numbers;
  const auto less = [](const std::optional<double>& a, const std::optional<double>& b) {
    return b && (!a || *a < *b);
  };
  const auto more = [](const std::optional<double>& a, const std::optional<double>& b) {
    return a && (!b || *a < *b);
  };
  const auto at = largest ? std::max_element(numbers.begin(), numbers.end(), less)
                          : std::min_element(numbers.begin(), numbers.end(), more);
  if (at != numbers.end() && *at) {
    picture.cross =
        Eigen::Map<const Vec3>(input.model.view().surface_positions.data() + 3 * (at - numbers.begin()));
    picture.cross_label =
        printed("%s, %.4g, at ", largest ? "largest" : "smallest", **at) + placeText(*picture.cross);
  }
  return bothSides(input.model, picture, about);
}

/// Touches that were solved, on a grey surface.
std::vector<Figure> touchesOn(const ReportInput& input, double Finding::*error, const std::string& about) {
  SurfacePicture picture;
  picture.bar_label = "error / %";
  picture.surface.numbers.resize(input.model.view().surfaceNodes());
  const Finding* worst = nullptr;
  for (const Finding& finding : input.found.findings) {
    const bool within = finding.outcome == Outcome::kWithin;
    if (!within && finding.outcome != Outcome::kBeyond) continue;
    picture.marks.push_back({finding.touch.position, 100.0 * finding.*error, !within});
    if (within && (worst == nullptr || finding.*error > worst->*error)) worst = &finding;
  }
  // The largest last, over the others.
  std::stable_sort(picture.marks.begin(), picture.marks.end(),
                   [](const picture::Mark& a, const picture::Mark& b) { return a.number < b.number; });
  if (worst != nullptr) {
    picture.cross = worst->touch.position;
    picture.cross_label =
        printed("largest in the domain, %.3g %%, at ", 100.0 * worst->*error) + placeText(*picture.cross);
  }
  return bothSides(input.model, picture, about, " Discs: touches in the domain; squares: beyond it.");
}

program::SvgPlot plotOf(const ForceCurve& curve, std::optional<double> error) {
  program::SvgPlot plot;
  plot.width = kWidth;
  plot.x_label = "depth / mm";
  plot.y_label = "force along d / N";
  if (error) {
    program::Series band{printed("E up to %g %% off", 100.0 * *error), {}, {}, {}, {}, Look::kLine, 0};
    for (std::size_t i = 0; i < curve.depth.size(); ++i) {
      band.x.push_back(1e3 * curve.depth[i]);
      band.y.push_back((1.0 - *error) * curve.force[i]);
      band.y_end.push_back((1.0 + *error) * curve.force[i]);
    }
    plot.series.push_back(band);
  }
  program::Series within{"model", {}, {}, {}, {}, Look::kLine, 0},
      beyond{"model, beyond its domain", {}, {}, {}, {}, Look::kDashed, 0};
  for (std::size_t i = 0; i < curve.depth.size(); ++i) {
    program::Series& part = curve.depth[i] <= curve.domain_radius ? within : beyond;
    if (&part == &beyond && beyond.x.empty() && !within.x.empty()) {
      beyond.x.push_back(within.x.back());
      beyond.y.push_back(within.y.back());
    }
    part.x.push_back(1e3 * curve.depth[i]);
    part.y.push_back(curve.force[i]);
  }
  plot.series.push_back(within);
  if (!beyond.x.empty()) plot.series.push_back(beyond);
  program::Series newton{"full Newton", {}, {}, {}, {}, Look::kDiscs, 1};
  for (const ForceCurve::Solved& one : curve.newton) {
    newton.x.push_back(1e3 * one.depth);
    newton.y.push_back(one.force);
  }
  plot.series.push_back(newton);
  return plot;
}

Figure curveFigure(const ForceCurve& curve, std::optional<double> error) {
  const std::string about =
      curve.place == "typical"
          ? "Force over depth at the typical place " + placeText(curve.position) + ", straight in"
          : "Force over depth at the worst touch " + placeText(curve.position) + ", in its direction " +
                directionText(curve.direction);
  double off = 0.0;
  for (const ForceCurve::Solved& one : curve.newton) off = std::max(off, one.error);
  std::string caption = about + printed(". The model's domain ends at %.3g mm.", 1e3 * curve.domain_radius);
  if (!curve.newton.empty())
    caption += printed(" Full Newton's points are within %.2g %% of it.", 100.0 * off);
  if (curve.not_converged > 0)
    caption += printed(" %zu of the points have no full solution.", curve.not_converged);
  return {plotOf(curve, error).render(), about + ": the model's curve and points of full Newton.", caption};
}

}  // namespace

Figures figuresOf(const ReportInput& input) {
  Figures figures;
  figures.stiffness = mapOf(input, input.maps.normal_stiffness, true, "stiffness, N/m",
                            "Stiffness felt along the normal, at rest");
  figures.reach = mapOf(input, scaled(input.maps.domain_radius, 1e3), false, "reach d_max, mm",
                        "How far a tool may go from each place");
  figures.force_error = touchesOn(input, &Finding::force_error, "Error of the force of each touch");
  figures.field_error = touchesOn(input, &Finding::field_error, "Error of the field of each touch");
  program::SvgPlot errors = errorPlot(input.found.findings);
  errors.width = kWidth;
  figures.errors_by_length = {
      {errors.render(),
       "Errors of force and field of each touch over the length of d, on a logarithmic axis.",
       "Errors of each touch over how far the tool went. Discs: force; squares: field; hollow: beyond the "
       "domain."}};
  for (const ForceCurve& curve : input.curves)
    figures.curves.push_back(curveFigure(curve, input.youngs_modulus_error));
  return figures;
}

}  // namespace palpate::certify
