// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/index.h"
#include "core/base/multi_index.h"
#include "core/data/model_view.h"
#include "core/model/smooth_mixing.h"
#include "core/surface/contact_patches.h"
#include "core/surface/smooth_places.h"
#include "core/surface/surface_mesh.h"
#include "tools/modelfile/model_data.h"
#include "tools/solver/build/solver_setup.h"
#include "tools/solver/fit/near_field.h"
#include "tools/solver/series/series.h"

namespace palpate::solver {

inline constexpr double kShortestEdge = 1.15;  ///< that adds something, in patch radii
inline constexpr double kEdgeReach = 3.0;      ///< of what it adds, in patch radii

/// The largest radius up to a cap at which something is trusted that is not trusted any more beyond some radius; at least a
/// 4096th of the cap, m.
template <typename Trusted>
double largestTrusted(double cap, const Trusted& is_trusted) {
  constexpr int kHalvings = 12;
  if (is_trusted(cap)) return cap;
  double good = cap / 4096.0, bad = cap;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double middle = 0.5 * (good + bad);
    (is_trusted(middle) ? good : bad) = middle;
  }
  return good;
}

/// What one edge adds.
struct Surplus {
  std::vector<std::int32_t> nodes;
  std::vector<float> field;  // [Ce][nodes][3]
  double force_radius{0.0};  // EdgeFields::forceRadius()
};

/// The edges between contact positions, and what their middles have beyond the model's own mixture there. Borrows all.
class EdgeFields {
 public:
  /// @param order  of what edges add  @param data  with surface, contact positions, modes and near field
  EdgeFields(const SolverSetup& setup, const ContactPatches& patches, int order,
             const modelfile::ModelData& data);

  [[nodiscard]] std::size_t count() const { return places_.size() - view_.positions(); }
  [[nodiscard]] bool isLong(std::size_t edge) const;
  [[nodiscard]] Patch patch(std::size_t edge, PatchNodes& room) const;
  [[nodiscard]] Surplus surplus(const SeriesSolver& series, int lane, std::size_t edge) const;
  [[nodiscard]] double added(const Surplus& own, double travel) const {
    return size(own, travel / data_.attributes.reference_displacement, 0) / travel;
  }
  /// d up to which the field there misses the asked part of abs(d), m, at most a cap. @param error  of abs(d)
  [[nodiscard]] double radius(const Surplus& own, double cap, double error) const;
  /// d up to which the mixed force misses the asked part of the edge's own, m. @param error  relative
  [[nodiscard]] double forceRadius(const SeriesSolver& series, int lane, std::size_t edge,
                                   double error) const;
  /// The contact positions at its ends.
  [[nodiscard]] std::array<std::size_t, 2> ends(std::size_t edge) const;

 private:
  [[nodiscard]] const ContactPoint& middle(std::size_t edge) const {
    return places_.views(view_.positions() + edge).front().s;
  }
  [[nodiscard]] double size(const Surplus& own, double r, int degree) const;
  void subtractMixture(const Stencil& stencil, const NearNodes& near, Eigen::MatrixXf& u) const;

  const SolverSetup& setup_;
  const ContactPatches& patches_;
  const modelfile::ModelData& data_;
  ModelView view_;
  SurfaceMesh surface_;
  SmoothMixing mixing_;
  SmoothPlaces places_;
  MonomialBasis basis_;
  std::size_t rows_, position_rows_, modes_;
  Eigen::Map<const Eigen::MatrixXf> X_;
};

}  // namespace palpate::solver
