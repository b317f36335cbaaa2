// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/examination.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>

#include "core/response/patch_response.h"
#include "tools/examine/certify/certify_error.h"
#include "tools/examine/certify/draws.h"
#include "tools/examine/query/answer.h"
#include "tools/program/printed.h"
#include "tools/solver/base/parallel.h"
#include "tools/solver/base/progress.h"

namespace palpate::certify {

namespace {

/// Those that are solved: all in the domain, and the first `flagged` of the others.
std::vector<Finding*> chosen(std::vector<Finding>& drawn, std::size_t flagged) {
  std::vector<Finding*> list;
  for (Finding& finding : drawn) {
    if (finding.flagged && flagged == 0) continue;
    if (finding.flagged) --flagged;
    list.push_back(&finding);
  }
  return list;
}

class Examiner {
 public:
  Examiner(const MetaModel& model, const query::Organ& organ, double travel, int threads)
      : model_(model),
        organ_(organ),
        travel_(travel),
        threads_(threads),
        reference_(organ, model.attributes().patch_radius, threads) {}

  /// Fills in what is found of each, several at a time, since their starts take memory.
  void solve(std::span<Finding* const> findings, solver::Progress& progress) {
    constexpr std::size_t kAtOnce = 96;
    for (; !findings.empty(); findings = findings.subspan(std::min(kAtOnce, findings.size())))
      solveBatch(findings.first(std::min(kAtOnce, findings.size())), progress);
  }

 private:
  void solveBatch(std::span<Finding* const> findings, solver::Progress& progress) {
    std::vector<Touch> touches;
    for (const Finding* finding : findings) touches.push_back(finding->touch);
    const std::vector<Eigen::VectorXd> starts = reference_.starts(touches);
    solver::parallelFor(threads_, findings.size(), [&](int thread, std::size_t i) {
      Finding& finding = *findings[i];
      const auto truth = reference_.solve(std::span(&finding.touch, 1), starts[i], thread);
      finding.outcome = Outcome::kNotSolved;
      if (truth) compare(model_, organ_, *truth, travel_, finding);
      progress.advance();
    });
  }

  const MetaModel& model_;
  const query::Organ& organ_;
  double travel_;
  int threads_;
  ReferenceSolver reference_;
};

}  // namespace

const char* toString(Outcome outcome) noexcept {
  switch (outcome) {
    case Outcome::kWithin:
      return "within";
    case Outcome::kBeyond:
      return "beyond";
    case Outcome::kNotSolved:
      return "not_converged";
    case Outcome::kNotExamined:
      break;
  }
  return "not_examined";
}

std::vector<Finding> Examination::of(Outcome outcome) const {
  std::vector<Finding> list;
  std::copy_if(findings.begin(), findings.end(), std::back_inserter(list),
               [outcome](const Finding& finding) { return finding.outcome == outcome; });
  return list;
}

std::size_t Examination::count(Outcome outcome) const {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [outcome](const Finding& finding) { return finding.outcome == outcome; }));
}

Examination examine(const MetaModel& model, const query::Organ& organ, TouchSampler& touches, double travel,
                    const Extent& extent) {
  Examiner examiner(model, organ, travel, extent.threads);
  std::size_t flagged = 0;
  const auto next = [&] {
    Finding finding;
    finding.touch = touches.next();
    finding.flagged = isBeyond(model, finding.touch);
    return finding;
  };
  const auto solve = [&](std::vector<Finding>& drawn) {
    const std::vector<Finding*> list = chosen(drawn, extent.samples - flagged);
    flagged += static_cast<std::size_t>(
        std::count_if(list.begin(), list.end(), [](const Finding* finding) { return finding->flagged; }));
    solver::Progress progress("full solutions", list.size());
    examiner.solve(list, progress);
  };
  return {drawAndSolve(extent.samples, next, solve,
                       [](const Finding& finding) { return finding.outcome == Outcome::kWithin; })};
}

bool isBeyond(const MetaModel& model, const Touch& touch) {
  Response response;
  return respond(model, touch.s, touch.d, response) != ResponseStatus::kOk;
}

double forceError(const MetaModel& model, const Touch& touch, const Vec3& force, const Vec3& truth,
                  double travel) {
  constexpr double kFloor = 0.05;  // of the force at the travel
  Response at_travel;
  (void)respond(model, touch.s, travel * touch.d.normalized(), at_travel);  // it goes on beyond the domain
  return (force - truth).norm() / std::max(truth.norm(), kFloor * at_travel.force.norm());
}

double fieldError(std::span<const float> field, const query::FullSolution& truth, const query::Organ& organ,
                  double length) {
  // A maximum would miss NaN.
  if (!std::all_of(field.begin(), field.end(), [](float u) { return std::isfinite(u); }))
    return std::numeric_limits<double>::infinity();
  return query::fieldErrors(field, truth, organ, length).max;
}

void requireFinite(const Touch& touch, double force_error, double field_error) {
  if (std::isfinite(force_error) && std::isfinite(field_error)) return;
  const auto text = [](const Vec3& v) { return program::printed("(%g, %g, %g) m", v[0], v[1], v[2]); };
  throw CertifyError("the touch at " + text(touch.position) + " by " + text(touch.d) +
                     " has a force error of " + program::printed("%g", force_error) +
                     " and a field error of " + program::printed("%g", field_error) +
                     ", expected finite answers");
}

void compare(const MetaModel& model, const query::Organ& organ, const query::FullSolution& truth,
             double travel, Finding& finding) {
  const Touch& touch = finding.touch;
  const query::Answer answer = query::ask(model, {touch.s, touch.position, 0}, touch.d);
  finding.outcome = finding.flagged ? Outcome::kBeyond : Outcome::kWithin;
  finding.force_error = forceError(model, touch, answer.response.force, truth.state.force, travel);
  finding.field_error = fieldError(answer.field, truth, organ, touch.d.norm());
  requireFinite(touch, finding.force_error, finding.field_error);
  finding.min_det_f = truth.min_det_f;
}

}  // namespace palpate::certify
