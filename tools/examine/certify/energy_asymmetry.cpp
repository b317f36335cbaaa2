// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/certify/energy_asymmetry.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/base/multi_index.h"

namespace palpate::certify {

namespace {

/// The forces of one position, their degree as in the file. Lengths over d_ref.
class FileForces {
 public:
  explicit FileForces(int order)
      : basis_(order),
        energy_basis_(order + 1),
        value_(static_cast<std::size_t>(basis_.size())),
        slope_(static_cast<std::size_t>(energy_basis_.size())),
        energy_(slope_.size()) {}

  /// @param coefficients  [Cf][3], N; borrowed
  void take(std::span<const double> coefficients) {
    force_ = coefficients;
    std::fill(energy_.begin(), energy_.end(), 0.0);
    for (int k = 0; k < basis_.size(); ++k)
      for (std::size_t i = 0; i < 3; ++i) {
        MultiIndex beta = basis_[k];
        ++beta[i];
        energy_[static_cast<std::size_t>(MonomialBasis::positionOf(beta))] +=
            force_[3 * static_cast<std::size_t>(k) + i] / (beta[0] + beta[1] + beta[2]);
      }
  }
  [[nodiscard]] Vec3 force(const Vec3& p) {
    basis_.evaluate(p, value_);
    Vec3 f = Vec3::Zero();
    for (std::size_t k = 0; k < value_.size(); ++k)
      f += value_[k] * Eigen::Map<const Vec3>(force_.data() + 3 * k);
    return f;
  }
  /// dW/dd.
  [[nodiscard]] Vec3 derivative(const Vec3& p) {
    energy_basis_.gradient(p, slope_);
    Vec3 f = Vec3::Zero();
    for (std::size_t k = 0; k < slope_.size(); ++k) f += energy_[k] * slope_[k];
    return f;
  }

 private:
  MonomialBasis basis_, energy_basis_;
  std::span<const double> force_;
  std::vector<double> value_;
  std::vector<Vec3> slope_;
  std::vector<double> energy_;  // over d_ref
};

/// To the corners, edges and faces of a cube.
std::vector<Vec3> directions() {
  std::vector<Vec3> list;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0) list.push_back(Vec3(x, y, z).normalized());
  return list;
}

}  // namespace

double energyAsymmetry(const MetaModel& model) {
  const ModelView& v = model.view();
  const std::vector<Vec3> around = directions();
  FileForces forces(model.attributes().force_order);
  const std::size_t numbers = v.contact_force.size() / v.positions();
  double worst = 0.0;
  for (std::size_t m = 0; m < v.positions(); ++m) {
    forces.take(v.contact_force.subspan(numbers * m, numbers));
    double largest = 0.0, off = 0.0;
    for (const double part : {0.25, 0.5, 0.75, 1.0})
      for (const Vec3& e : around) {
        const Vec3 p = part * v.contact_domain_radius[m] / model.attributes().reference_displacement * e;
        const Vec3 f = forces.force(p);
        largest = std::max(largest, f.norm());
        off = std::max(off, (f - forces.derivative(p)).norm());
      }
    if (largest > 0.0) worst = std::max(worst, off / largest);
  }
  return worst;
}

}  // namespace palpate::certify
