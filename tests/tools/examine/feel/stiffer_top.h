// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "core/model/meta_model.h"
#include "palpate/testing/files.h"
#include "palpate/testing/synthetic_model.h"
#include "tools/modelfile/write_model.h"

namespace palpate::testing {

inline const SyntheticOptions kTopOptions{
    .subdivisions = 4, .order = 1, .force_order = 3, .modes = 1, .near_radius = 0.0, .nodule_above = 0.9};
inline const Vec3 kTop(0.0, 0.0, kTopOptions.radius);  // a node, and straight above the nodule
inline constexpr double kMost = 0.6;                   // contrast there
inline constexpr double kWidth = 0.015;                // m

/// At a straight distance r from the top, m.
inline double contrastAt(double r) {
  return kMost * std::exp(-r * r / (kWidth * kWidth));
}
inline double contrastAt(const Vec3& X) {
  return contrastAt((X - kTop).norm());
}

/// A round organ, 1 + most / kMost * contrastAt(X) times as stiff as one that is alike everywhere.
inline modelfile::ModelData stifferTop(double most) {
  modelfile::ModelData data = syntheticModel(kTopOptions);
  const auto stiffening = [&](const Vec3& X) { return 1.0 + most / kMost * contrastAt(X); };
  fillStiffness(data, [&](const Vec3& X) -> Mat3 {
    const Vec3 n = X.normalized();
    return stiffening(X) * kTopOptions.stiffness * (Mat3::Identity() + 0.5 * n * n.transpose());
  });
  const std::size_t numbers = data.contact_force.size() / data.contact_node.size();
  for (std::size_t i = 0; i < data.contact_force.size(); ++i) {
    const auto node = static_cast<std::size_t>(data.contact_node[i / numbers]);
    data.contact_force[i] *= stiffening(Eigen::Map<const Vec3>(data.surface_positions.data() + 3 * node));
  }
  return data;
}

inline MetaModel modelOf(const modelfile::ModelData& data) {
  const TemporaryFile file("contrast.h5");
  modelfile::writeModel(file.path(), data);
  return MetaModel::load(file.path());
}

}  // namespace palpate::testing
