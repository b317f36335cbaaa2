// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::solver {

/// Lame's constants, as laws read them in an integration point.
struct Lame {
  double lambda;  ///< Pa
  double mu;      ///< Pa
};

/// Stiffness of an isotropic material at small strains: the numbers of every law.
struct Elasticity {
  double E{160e3};  ///< Young's modulus, Pa, > 0
  double nu{0.48};  ///< Poisson's ratio, in (-1, 0.5)

  [[nodiscard]] Lame lame() const noexcept {
    return {E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))};
  }
  /// @throw std::invalid_argument for numbers that no solid has
  void requireSolid() const {
    if (!(E > 0.0) || !(nu > -1.0) || !(nu < 0.5))
      throw std::invalid_argument("material: E = " + std::to_string(E) + " Pa, nu = " + std::to_string(nu) +
                                  "; expected E > 0 and -1 < nu < 0.5");
  }
};

/// A law as CalculiX knows it, under NLGEOM.
struct CcxMaterial {
  std::string_view keyword;       ///< such as "*ELASTIC"
  std::vector<double> constants;  ///< of the line after it, SI
};

}  // namespace palpate::solver
