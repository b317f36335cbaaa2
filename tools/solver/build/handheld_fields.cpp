// SPDX-License-Identifier: Apache-2.0
// What a small file has in fewer modes, fewer nodes and fewer digits.              docs/decisions/handheld.md
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/index.h"
#include "tools/solver/build/build_model_parts.h"
#include "tools/solver/build/displacement_builder.h"
#include "tools/solver/build/displacement_fields.h"
#include "tools/solver/build/shared_loads.h"

namespace palpate::solver {

/// By node of the near fields of loads, how far the whole force of a patch there moves it over abs(d).
std::vector<float> DisplacementBuilder::greenSizes() const {
  std::vector<float> sizes;
  for (std::size_t g = 0; g < loaded_.size(); ++g) {
    const Vec3& place = setup_.surface.positions[index(loaded_[g])];
    const auto apart = [&](std::int32_t node) {
      return (setup_.surface.positions[index(node)] - place).squaredNorm();
    };
    const auto nearest =
        std::min_element(setup_.positions.nodes.begin(), setup_.positions.nodes.end(),
                         [&](std::int32_t l, std::int32_t r) { return apart(l) < apart(r); });
    const double* const K =
        data_.contact_stiffness.data() +
        kStiffnessNumbers * static_cast<std::size_t>(nearest - setup_.positions.nodes.begin());
    const double stiffest = Mat3{{K[0], K[4], K[8]}, {K[4], K[12], K[16]}, {K[8], K[16], K[20]}}.norm();
    const auto count = data_.green_offset[g + 1] - data_.green_offset[g];
    const float* const near = data_.green_near.data() + 9 * data_.green_offset[g];
    for (std::int64_t j = 0; j < count; ++j) {
      double square = 0.0;
      for (std::int64_t load = 0; load < 3; ++load)
        square = std::max(
            square, double{Eigen::Map<const Eigen::Vector3f>(near + 3 * (load * count + j)).squaredNorm()});
      sizes.push_back(static_cast<float>(stiffest * std::sqrt(square)));
    }
  }
  return sizes;
}

void DisplacementBuilder::storeCompactFields(const FitProblem& problem, const FarField& far) {
  std::vector<FitSource> pressed(problem.sources.begin(), problem.sources.end());
  for (std::size_t p = 0; p < pressed.size(); ++p)
    pressed[p].ball_radius = std::min(case_.travelOrDefault(), data_.contact_series_radius[p]);
  const FitProblem travelled{problem.table, problem.basis, problem.areas, problem.places, pressed, d_ref_};
  FarField bent;  // orders of two and more are smaller: fewer modes do
  bent.X = far.X.leftCols(SizeBudget::positionModes(far.X.cols()));
  bent.Y = amplitudesOf(problem, bent.X, options_.workers);
  data_.position_modes = static_cast<std::size_t>(bent.X.cols());
  NearSizes sizes;
  sizes.positions = storeNearField(travelled, bent, near_, options_.workers, data_);
  sizes.greens = greenSizes();
  report_.size = budget_->leaveOut(sizes, data_);
}

/// Surface nodes: those that patches load, or what shares their loads.
std::vector<std::int32_t> DisplacementBuilder::sourcesOfLoads() const {
  std::vector<std::int32_t> shared;
  if (case_.handheld()) shared = sharedSources(setup_.surface, loaded_);
  return shared.empty() ? loaded_ : shared;
}

/// A third as many sources of the linear field, where elements are quadratic. @return their fields, or null
std::unique_ptr<FieldTable> DisplacementBuilder::shareLoads(const FieldTable& greens) {
  const SharedLoads shared = sharedLoads(setup_, patches_, loaded_, options_.workers, options_.quiet);
  if (shared.nodes.empty()) return nullptr;
  auto fields = std::make_unique<FieldTable>(ScratchPlace(options_.scratch),
                                             blocksOf(setup_, shared.nodes, 1, *options_.ranks),
                                             std::size_t{3}, greens.rows());
  superpose(greens, shared, options_, *fields);
  report_.shared_loads = shared.error;
  loaded_ = shared.nodes;
  near_loaded_ = nearOf(loaded_);
  return fields;
}

/// What a small file has in fewer digits: floats are enough for a force, a stiffness and a radius.
void DisplacementBuilder::makeCompact() {
  constexpr int kRoundedTriangles = 75'000;  // they are made at each start, and a small machine takes long
  data_.compact = true;
  data_.attributes.rounded_triangles = kRoundedTriangles;
  for (std::vector<double>* const numbers : {&data_.contact_force, &data_.contact_stiffness,
                                             &data_.contact_domain_radius, &data_.contact_series_radius})
    for (double& number : *numbers) number = double{static_cast<float>(number)};
  budget_.emplace(data_, loaded_.size(), case_.sizeLimitOrDefault());
}

}  // namespace palpate::solver
