// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <variant>
#include <vector>

#include "tools/solver/base/cauchy_product.h"
#include "tools/solver/base/part_tensors.h"
#include "tools/solver/fem/elasticity.h"
#include "tools/solver/fem/st_venant_kirchhoff.h"

namespace palpate::solver {

/// What a law of the material is: a type without data that answers, in one integration point,
///   kName         its name in the model file (core's kLaws) and in case files
///   check         throws std::invalid_argument for numbers that it cannot take
///   ccx           the law in a CalculiX deck
///   energy        Psi(H), Pa
///   stress        P(H) = dPsi/dH, Pa
///   tangent       3 N x 3 N, node-interleaved, Pa/m^2: block (a, b) is dP/dH contracted with dN_a and dN_b, the
///                 rows of g (N x 3, 1/m)
///   Series        the terms of its power series                                        docs/design.md, Series
/// A Series is made from Lame's constants and H_k (k < fields; the others are zero), and keeps what it needs of
/// lower degrees:
///   carry         its own quantities of coefficient k; called in the order of k
///   lowerOrders   P_k without the part that is linear in H_k, when all lower degrees are carried
///   energy        W_k, Pa, when its factors are carried
/// Its functions are inlined into kernels: no calls, and Part by reference only.
template <typename L>
concept MaterialLaw = requires(const Lame& m, const Elasticity& e, const Eigen::Matrix3d& H,
                               const Eigen::Matrix<double, 4, 3>& g, typename L::Series& series,
                               const CauchyProduct& pairs, int k, PartTensor& P, Part& W) {
  { L::kName } -> std::convertible_to<std::string_view>;
  L::check(e);
  { L::ccx(e) } -> std::same_as<CcxMaterial>;
  { L::energy(m, H) } -> std::same_as<double>;
  { L::stress(m, H) } -> std::same_as<Eigen::Matrix3d>;
  { L::tangent(m, H, g) } -> std::same_as<Eigen::Matrix<double, 12, 12>>;
  requires std::constructible_from<typename L::Series, const Lame&, const PartTensor*, int>;
  series.carry(pairs, k);
  series.lowerOrders(pairs, k, P);
  series.energy(pairs, k, W);
};

template <MaterialLaw... L>
using LawList = std::variant<L...>;

/// Every law that there is. A further one is its own file and its name here and in core's kLaws.
using Law = LawList<StVenantKirchhoff>;

/// The law of a name. @throw std::invalid_argument that lists the names
[[nodiscard]] Law lawOf(std::string_view name);

/// What a body is made of: one law, and its numbers in each element.
struct Material {
  Elasticity elasticity;  ///< of all elements, or for reports where they differ
  Law law{};
  std::vector<Elasticity> by_element{};  ///< where stiffness differs by region, one per element; else empty

  [[nodiscard]] const Elasticity& of(std::size_t element) const noexcept {
    return by_element.empty() ? elasticity : by_element[element];
  }
  /// @throw std::invalid_argument for numbers that the law cannot take, or another number of elements
  void check(std::size_t elements) const;
};

}  // namespace palpate::solver
