// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tools/solver/base/cauchy_product.h"
#include "tools/solver/base/part_tensors.h"
#include "tools/solver/fem/elasticity.h"
#include "tools/solver/fem/st_venant_kirchhoff.h"
#include "tools/solver/fem/stable_neo_hookean.h"

namespace palpate::solver {

/// What a law of the material is: a type without data that answers, in one integration point,
///   kName         its name in the model file (core's kLaws) and in case files
///   check         throws std::invalid_argument for numbers that it cannot take
///   ccx           the law in a CalculiX deck
///   energy        Psi(H), Pa
///   stress        P(H) = dPsi/dH, Pa
///   tangent       3 N x 3 N, node-interleaved, Pa/m^2: block (a, b) is dP/dH contracted with dN_a and dN_b, the
///                 rows of g (N x 3, 1/m)
///   Series        the terms of the power series of P                               docs/design.md, Series
///   EnergySeries  those of W, in float32
/// Both are made from Lame's constants and H_k (k < fields; the others are zero), and keep what they need of lower
/// degrees:
///   carry         their own quantities of coefficient k; called in the order of k
///   Series::lowerOrders        P_k without the part that is linear in H_k, when all lower degrees are carried
///   EnergySeries::addEnergies  W_k += weight Psi_k for all k of the rows, when all factors are carried
/// Series works in Part, EnergySeries in FloatLanes, with fields of d / length: its numbers are near 1 in any unit.
/// Their functions are inlined into kernels: no calls, and registers by reference only.
template <typename L>
concept MaterialLaw = requires(const Lame& m, const Elasticity& e, const Eigen::Matrix3d& H,
                               const Eigen::Matrix<double, 4, 3>& g, typename L::Series& series,
                               typename L::EnergySeries& energies, const CauchyProduct& pairs,
                               const CauchyRows& rows, int k, PartTensor& P, float weight, FloatLanes* W) {
  { L::kName } -> std::convertible_to<std::string_view>;
  L::check(e);
  { L::ccx(e) } -> std::same_as<CcxMaterial>;
  { L::energy(m, H) } -> std::same_as<double>;
  { L::stress(m, H) } -> std::same_as<Eigen::Matrix3d>;
  { L::tangent(m, H, g) } -> std::same_as<Eigen::Matrix<double, 12, 12>>;
  requires std::constructible_from<typename L::Series, const Lame&, const PartTensor*, int>;
  requires std::constructible_from < typename L::EnergySeries, const Lame&, const Tensor<float>
  *, int > ;
  series.carry(pairs, k);
  series.lowerOrders(pairs, k, P);
  energies.carry(pairs, k);
  energies.addEnergies(rows, weight, W);
};

template <MaterialLaw... L>
using LawList = std::variant<L...>;

/// Every law that there is. A further one is its own file and its name here and in core's kLaws.
using Law = LawList<StVenantKirchhoff, StableNeoHookean>;

/// The law of a name. @throw std::invalid_argument that lists the names
[[nodiscard]] Law lawOf(std::string_view name);

/// A part of the body with its own material.
struct Region {
  std::string name;
  Elasticity elasticity;
  Law law{};
};

/// What a body is made of: one law with one pair of numbers, or those of the region that an element belongs to.
struct Material {
  Elasticity elasticity;  ///< of all elements, or for reports where they differ
  Law law{};
  std::vector<Region> regions{};                  ///< empty: all elements are alike
  std::vector<std::int32_t> region_of_element{};  ///< into regions; empty as they are

  [[nodiscard]] const Elasticity& of(std::size_t element) const noexcept {
    return regions.empty() ? elasticity : regionOf(element).elasticity;
  }
  [[nodiscard]] Law lawIn(std::size_t element) const noexcept {
    return regions.empty() ? law : regionOf(element).law;
  }
  /// @throw std::invalid_argument for numbers that a law cannot take, or elements without a region
  void check(std::size_t elements) const;

 private:
  [[nodiscard]] const Region& regionOf(std::size_t element) const noexcept {
    return regions[static_cast<std::size_t>(region_of_element[element])];
  }
};

}  // namespace palpate::solver
