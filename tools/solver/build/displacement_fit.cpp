// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <utility>

#include "core/base/index.h"
#include "tools/solver/base/journal.h"
#include "tools/solver/build/build_model_parts.h"
#include "tools/solver/build/displacement_builder.h"
#include "tools/solver/build/displacement_fields.h"

namespace palpate::solver {

namespace {

constexpr double kBegin = 0.6;              ///< of the modes that an error is expected to want
constexpr double kWider = 4.0 / 3.0;        ///< near fields, where the most modes are not enough
constexpr double kWidestNearField = 8.001;  ///< in patch radii

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", x);
  return buffer;
}

double nearBytes(std::span<const NearNodes> near, int coefficients) {
  double bytes = 0.0;
  for (const NearNodes& nodes : near) bytes += 12.0 * coefficients * static_cast<double>(nodes.nodes.size());
  return bytes;
}

std::vector<float> numbersOf(const Eigen::MatrixXf& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

void putFarField(record::Bytes& out, const FarField& far) {
  putArray(out, numbersOf(far.X));
  putArray(out, numbersOf(far.Y));
  putArray(out, far.errors);
  putArray(out, far.largest);
}

void getFarField(record::ByteSource& in, Eigen::Index rows, FarField& far) {
  std::vector<float> X, Y;
  getArray(in, X);
  getArray(in, Y);
  getArray(in, far.errors);
  getArray(in, far.largest);
  if (X.empty() || rows < 1) throw record::RecordError("a record has no modes");
  const Eigen::Index modes = static_cast<Eigen::Index>(X.size()) / rows;
  far.X = Eigen::Map<const Eigen::MatrixXf>(X.data(), rows, modes);
  far.Y = Eigen::Map<const Eigen::MatrixXf>(Y.data(), modes, static_cast<Eigen::Index>(Y.size()) / modes);
}

/// The near field is part of the model; this program and the server hold all of it in memory.
constexpr double kMostNearBytes = 2147483648.0;

}  // namespace

/// @throw CaseError  a near field that is too large
void DisplacementBuilder::checkNear() const {
  const double bytes = nearBytes(near_, basis_.size()) + nearBytes(near_loaded_, 3);
  if (bytes > kMostNearBytes)
    throw CaseError(case_.mesh.string() + ": near fields of model.near_radius = " + text(near_radius_) +
                    " m take " + text(1e-6 * bytes) + " MB; the limit is " + text(1e-6 * kMostNearBytes) +
                    " MB");
}

std::vector<NearNodes> DisplacementBuilder::nearOf(std::span<const std::int32_t> nodes) const {
  std::vector<NearNodes> near;
  for (const std::int32_t node : nodes)
    near.push_back(nearNodes(setup_.surface, setup_.surface.positions[index(node)], near_radius_));
  return near;
}

/// @param travel  m, of each; empty: d_ref
std::vector<FitSource> DisplacementBuilder::fitSources(std::span<const std::int32_t> nodes,
                                                       std::span<const double> travel) const {
  std::vector<FitSource> sources;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vec3& place = setup_.surface.positions[index(nodes[i])];
    // Large travel is rare and must not cost accuracy at small travel.
    const double ball = travel.empty() ? d_ref_ : std::min(d_ref_, travel[i]);
    sources.push_back({place, fitWeights(setup_.surface, place, near_radius_), ball, d_ref_});
  }
  return sources;
}

FitOptions DisplacementBuilder::fitOptions() const {
  FitOptions options;
  options.error = report_.fit_asked;
  options.modes = case_.modes.value_or(budget_ ? budget_->modes() : static_cast<int>(kBegin * sizes().modes));
  options.scratch = options_.scratch;
  options.head_start = 3;
  options.sweeps = case_.sweepsOrDefault();
  options.reweighted = std::min(2, options.sweeps);
  options.workers = options_.workers;
  options.quiet = options_.quiet;
  return options;
}

/// Near fields that reach further, where as many modes as may be miss the asked error. @return whether there are such
bool DisplacementBuilder::widenNear() {
  const double wider = kWider * near_radius_;
  if (report_.fit_p95 <= report_.fit_asked || report_.fit_asked == 0.0 || case_.near_radius ||
      wider > kWidestNearField * setup_.patch_radius)
    return false;
  const double usual = std::exchange(near_radius_, wider);
  near_ = nearOf(setup_.positions.nodes);
  near_loaded_ = nearOf(loaded_);
  bool fits = true;
  try {
    checkNear();
    Estimate more = sizes();
    more.scratch = 0.0;  // it is there already
    requireRoom(more, case_, options_, options_.output);
  } catch (const CaseError&) {
    fits = false;
  }
  // Each rank sees the room of its own machine; all fit again, or none.
  if (options_.ranks->all(fits)) return true;
  near_radius_ = usual;  // what is there is kept, and its error told
  near_ = nearOf(setup_.positions.nodes);
  near_loaded_ = nearOf(loaded_);
  return false;
}

/// The modes are those of the patches' fields, which are smoother than those of single nodes: they want fewer.
void DisplacementBuilder::fit(const FieldTable& table, const FieldTable& greens) {
  report_.fit_asked = case_.modes || budget_ ? 0.0 : case_.fieldErrorOrDefault();
  std::uint64_t attempt = 0;
  do {
    const std::vector<FitSource> sources = fitSources(setup_.positions.nodes, data_.contact_domain_radius);
    const FitProblem problem{table, basis_, setup_.surface.areas, setup_.surface.positions, sources, d_ref_};
    const FarField far = keptByFirstOr<FarField>(
        *options_.ranks, options_.journal("fit"), attempt++,
        [&] { return fitFarField(problem, fitOptions()); }, putFarField,
        [&](record::ByteSource& in, FarField& kept) {
          getFarField(in, static_cast<Eigen::Index>(table.rows()), kept);
        });
    report_.fit_errors = far.errors;
    std::vector<float> largest = far.largest;
    std::sort(largest.begin(), largest.end());
    report_.fit_p95 = largest[largest.size() - 1 - largest.size() / 20];
    report_.fit_max = largest.back();
    data_.modes_X.assign(far.X.data(), far.X.data() + far.X.size());
    if (!widenNear()) return storeFields(problem, far, greens);
  } while (true);
}

void DisplacementBuilder::storeFields(const FitProblem& problem, const FarField& far,
                                      const FieldTable& greens) {
  const std::vector<FitSource> loaded = fitSources(loaded_, {});
  const MonomialBasis linear(1);
  const FitProblem by_load{greens, linear, setup_.surface.areas, setup_.surface.positions, loaded, d_ref_};
  data_.green_node = loaded_;
  storeGreens(by_load, far.X, near_loaded_, options_.workers, data_);
  if (budget_)
    storeCompactFields(problem, far);
  else
    (void)storeNearField(problem, far, near_, options_.workers, data_);
}

}  // namespace palpate::solver
