// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/fit/estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <unsupported/Eigen/LevenbergMarquardt>

#include "tools/examine/fit/fit_error.h"
#include "tools/program/printed.h"

namespace palpate::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Unknowns: the scale and, where it is asked for, offset / unit. Residuals are over the points' errors.
struct Residuals : Eigen::DenseFunctor<double> {
  const MeasuredCurve& curve;
  const Press& press;
  double unit;             // m
  double unit_scale{1.0};  // of the first unknown

  Residuals(const MeasuredCurve& of, const Press& by, double length, bool find_offset)
      : DenseFunctor(find_offset ? 2 : 1, static_cast<int>(of.points.size())),
        curve(of),
        press(by),
        unit(length) {}

  [[nodiscard]] double scale(const VectorXd& x) const { return unit_scale * x[0]; }
  [[nodiscard]] double offset(const VectorXd& x) const { return x.size() > 1 ? unit * x[1] : 0.0; }
  [[nodiscard]] double error(Index i) const { return curve.points[static_cast<std::size_t>(i)].error; }
  [[nodiscard]] ForceAt at(const VectorXd& x, Index i) const {
    return press.at(curve.points[static_cast<std::size_t>(i)].depth - offset(x));
  }
  int operator()(const VectorXd& x, VectorXd& r) const {
    for (Index i = 0; i < r.size(); ++i) {
      const MeasuredPoint& point = curve.points[static_cast<std::size_t>(i)];
      r[i] = (scale(x) * at(x, i).force - point.force) / point.error;
    }
    return 0;
  }
  int df(const VectorXd& x, MatrixXd& J) const {
    for (Index i = 0; i < J.rows(); ++i) {
      const ForceAt f = at(x, i);
      J(i, 0) = unit_scale * f.force / error(i);
      if (J.cols() > 1) J(i, 1) = -scale(x) * unit * f.slope / error(i);
    }
    return 0;
  }
};

std::vector<double> sortedDepths(const MeasuredCurve& curve) {
  std::set<double> depths;
  for (const MeasuredPoint& point : curve.points) depths.insert(point.depth);
  return {depths.begin(), depths.end()};
}

/// Over the points' errors. @throw FitError naming the curve: their powers would overflow
VectorXd measuredForces(const Residuals& residuals) {
  constexpr double kMost = 1e100;
  VectorXd measured(residuals.values());
  for (Index i = 0; i < measured.size(); ++i)
    measured[i] = residuals.curve.points[static_cast<std::size_t>(i)].force / residuals.error(i);
  if (const double largest = measured.cwiseAbs().maxCoeff(); !(largest <= kMost))
    throw FitError(residuals.curve.name +
                   program::printed(": forces are up to %g (over their errors, where the file has these), "
                                    "expected at most %g",
                                    largest, kMost));
  return measured;
}

/// The best scale for an offset, and the sum of squares that it leaves.
struct Start {
  VectorXd x;
  double squares{std::numeric_limits<double>::infinity()};
};

/// @param measured  forces over the points' errors
Start bestScale(const Residuals& residuals, const VectorXd& at, const VectorXd& measured) {
  VectorXd x = at, f(residuals.values());
  for (Index i = 0; i < f.size(); ++i) f[i] = residuals.at(x, i).force / residuals.error(i);
  if (!(f.squaredNorm() > 0.0)) return {x};
  x[0] = f.dot(measured) / f.squaredNorm();
  return {x, (x[0] * f - measured).squaredNorm()};
}

/// Offsets from before the first reading up to where only as many points are in contact as it takes; the best.
Start scan(const Residuals& residuals, const std::vector<double>& depths) {
  constexpr int kSteps = 50;
  VectorXd x = VectorXd::Zero(residuals.inputs());
  const VectorXd measured = measuredForces(residuals);
  Start best = bestScale(residuals, x, measured);
  if (residuals.inputs() < 2) return best;
  const double low = std::min(depths.front() - residuals.unit, 0.0), high = depths[depths.size() - 3];
  for (int step = 0; step < kSteps; ++step) {
    x[1] = (low + (high - low) * step / kSteps) / residuals.unit;
    const Start other = bestScale(residuals, x, measured);
    if (other.squares < best.squares) best = other;
  }
  return best;
}

VectorXd minimum(const Residuals& of, const std::vector<double>& depths) {
  using Space = Eigen::LevenbergMarquardtSpace::Status;
  VectorXd x = scan(of, depths).x;
  // Columns of J of about the same length: the search takes a much shorter one for dependent.
  Residuals residuals = of;
  if (x[0] != 0.0) residuals.unit_scale = std::abs(x[0]);
  x[0] /= residuals.unit_scale;
  Eigen::LevenbergMarquardt<Residuals> search(residuals);
  search.setXtol(1e-12);
  search.setFtol(1e-14);
  const Space end = search.minimize(x);
  if (end == Space::ImproperInputParameters || end == Space::TooManyFunctionEvaluation || !x.allFinite())
    throw FitError(residuals.curve.name + ": the fit does not converge");
  x[0] *= residuals.unit_scale;
  return x;
}

/// Points that say something of the modulus, by their depth from contact.
void checkContact(const Estimate& found, const MeasuredCurve& curve, const Press& press,
                  std::size_t unknowns) {
  std::set<double> depths;
  double deepest = 0.0;
  for (const MeasuredPoint& point : curve.points) {
    const double depth = point.depth - found.offset.value;
    deepest = std::max(deepest, depth);
    if (depth > 0.0 && depth <= press.seriesRadius()) depths.insert(depth);
  }
  if (depths.size() <= unknowns)
    throw FitError(
        curve.name +
        program::printed(": %zu different depths are between contact and r_max = %g m, expected %zu "
                         "or more; the deepest is %g m from contact",
                         depths.size(), press.seriesRadius(), unknowns + 1, deepest));
  if (!(found.scale.value > 0.0))
    throw FitError(curve.name +
                   program::printed(": the force does not rise with depth: the best E is %g of the model's",
                                    found.scale.value));
}

/// Standard errors, the larger ones of both kinds.
VectorXd standardErrors(const MatrixXd& J, const MatrixXd& A, const VectorXd& r, std::size_t freedom) {
  constexpr double kLeast = 1e-9;  // of 1 - h: such a point lies on the curve by itself
  MatrixXd meat = MatrixXd::Zero(J.cols(), J.cols());
  double squares = 0.0;
  for (Index i = 0; i < J.rows(); ++i) {
    if (J.row(i).isZero(0.0)) continue;  // before contact
    const double left = std::max(1.0 - J.row(i).dot(A * J.row(i).transpose()), kLeast);
    meat += J.row(i).transpose() * J.row(i) * (r[i] * r[i] / (left * left));
    squares += r[i] * r[i];
  }
  const VectorXd alike = A.diagonal() * (squares / static_cast<double>(freedom));
  return (A * meat * A).diagonal().cwiseMax(alike).cwiseSqrt();
}

/// The most that each unknown moves when each force of the model is off by at most the given share, to first order.
VectorXd modelErrors(const Residuals& residuals, const MatrixXd& J, const MatrixXd& A, const VectorXd& x,
                     const ModelError& model) {
  VectorXd most = VectorXd::Zero(J.cols());
  for (Index i = 0; i < J.rows(); ++i) {
    const double force = std::max(residuals.at(x, i).force, model.floor);
    most +=
        (A * J.row(i).transpose()).cwiseAbs() * (model.share * std::abs(x[0]) * force / residuals.error(i));
  }
  return most;
}

void addIntervals(const Residuals& residuals, const VectorXd& x, const FitOptions& options, Estimate& found) {
  VectorXd r(residuals.values());
  MatrixXd J(residuals.values(), residuals.inputs());
  residuals(x, r);
  residuals.df(x, J);
  const MatrixXd A = (J.transpose() * J).inverse();
  const std::size_t freedom = found.in_contact - static_cast<std::size_t>(residuals.inputs());
  const VectorXd errors = standardErrors(J, A, r, freedom),
                 model = modelErrors(residuals, J, A, x, options.model);
  const double t =
      quantile(boost::math::students_t(static_cast<double>(freedom)), 0.5 + 0.5 * options.confidence);
  found.scale = {x[0], errors[0], t * errors[0], model[0]};
  if (x.size() < 2) return;
  const double unit = residuals.unit;
  found.offset = {unit * x[1], unit * errors[1], t * unit * errors[1], unit * model[1]};
}

}  // namespace

Estimate estimate(const MeasuredCurve& curve, const Press& press, const FitOptions& options) {
  const std::vector<double> depths = sortedDepths(curve);
  if (depths.size() < 3)
    throw FitError(curve.name + " has " + std::to_string(depths.size()) +
                   " different depths, expected 3 or more");
  const Residuals residuals(curve, press, depths.back() - depths.front(), options.find_offset);
  const VectorXd x = minimum(residuals, depths);
  Estimate found;
  found.scale.value = x[0];
  found.offset.value = residuals.offset(x);
  for (const MeasuredPoint& point : curve.points) {
    const ForceAt f = press.at(point.depth - found.offset.value);
    found.expected.push_back(x[0] * f.force);
    found.residual.push_back(point.force - x[0] * f.force);
    if (point.depth > found.offset.value) ++found.in_contact;
    if (f.beyond) ++found.beyond;
  }
  checkContact(found, curve, press, static_cast<std::size_t>(x.size()));
  addIntervals(residuals, x, options, found);
  return found;
}

}  // namespace palpate::fit
