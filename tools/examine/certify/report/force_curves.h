// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/examine/certify/examination.h"
#include "tools/examine/certify/report/surface_maps.h"

namespace palpate::certify {

/// The force at one place over how far a tool goes in one direction: the model's, and full Newton's at some of the depths.
struct ForceCurve {
  /// A depth that was solved in full.
  struct Solved {
    double depth;  ///< m
    double force;  ///< f_Newton . e, N
    double error;  ///< |f - f_Newton| / |f_Newton|
  };
  std::string place;  ///< "typical" or "worst"
  ContactPoint s;
  Vec3 position = Vec3::Zero();   ///< X(s), m
  Vec3 direction = Vec3::Zero();  ///< e, unit
  double domain_radius{0.0};      ///< d_max(s), m
  std::vector<double> depth;      ///< m, rising from 0 to the travel
  std::vector<double> force;      ///< f . e, N
  std::vector<Solved> newton;     ///< rising
  std::size_t not_converged{0};   ///< depths without a full solution
};

/// At the node of median stiffness straight in, and at the touch whose force is off most, in its direction. Quarters of the
/// travel are solved in full, and the length of that touch. A missing place is left out. Takes a second or so for
/// each of nine solutions.
/// @param travel  m  @throw query::QueryError, std::runtime_error
[[nodiscard]] std::vector<ForceCurve> forceCurves(const MetaModel& model, const query::Organ& organ,
                                                  const Examination& found, const SurfaceMaps& maps,
                                                  double travel, int threads);

}  // namespace palpate::certify
