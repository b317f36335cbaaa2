// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/base/multi_index.h"
#include "tools/solver/base/cauchy_product.h"
#include "tools/solver/base/part_tensors.h"
#include "tools/solver/fem/elasticity.h"

namespace palpate::solver {

/// Saint Venant-Kirchhoff:                                                        paper Eqs. (13), (15)
///   Psi = lambda/2 (tr E)^2 + mu E : E,  S = lambda tr(E) I + 2 mu E,  P = F S,  E = (H + H^T + H^T H) / 2
/// What each function owes is with MaterialLaw.
struct StVenantKirchhoff {
  using Mat3 = Eigen::Matrix3d;

  static constexpr std::string_view kName = "stvk";

  static void check(const Elasticity& e) {
    if (!(e.E > 0.0) || !(e.nu > -1.0) || !(e.nu < 0.5))
      throw std::invalid_argument("material: E = " + std::to_string(e.E) +
                                  " Pa, nu = " + std::to_string(e.nu) + "; expected E > 0 and -1 < nu < 0.5");
  }

  /// Under NLGEOM *ELASTIC is this law.
  static CcxMaterial ccx(const Elasticity& e) { return {"*ELASTIC", {e.E, e.nu}}; }

  static double energy(const Lame& m, const Mat3& H) {
    const Mat3 E = strain(H);
    return 0.5 * E.cwiseProduct(second(m, E)).sum();
  }

  static Mat3 stress(const Lame& m, const Mat3& H) {
    const Mat3 S = second(m, strain(H));
    return (Mat3::Identity() + H) * S;
  }

  template <int N>
  static Eigen::Matrix<double, 3 * N, 3 * N> tangent(const Lame& m, const Mat3& H,
                                                     const Eigen::Matrix<double, N, 3>& g) {
    const Mat3 F = Mat3::Identity() + H;
    const Mat3 S = second(m, strain(H));
    const Mat3 FFt = F * F.transpose();
    const Eigen::Matrix<double, N, 3> Fg = g * F.transpose();  // row a: F dN_a
    Eigen::Matrix<double, 3 * N, 3 * N> K;
    for (int a = 0; a < N; ++a) {
      for (int b = 0; b < N; ++b) {
        // C for an isotropic body: lambda I(x)I + 2 mu sym, contracted with F dN_a and F dN_b.
        const double geometric = g.row(a) * S * g.row(b).transpose();
        const double dots = m.mu * g.row(a).dot(g.row(b));
        K.template block<3, 3>(3 * a, 3 * b) = m.lambda * Fg.row(a).transpose() * Fg.row(b) +
                                               m.mu * Fg.row(b).transpose() * Fg.row(a) + dots * FFt +
                                               geometric * Mat3::Identity();
      }
    }
    return K;
  }

  class Series;

 private:
  static Mat3 strain(const Mat3& H) { return 0.5 * (H + H.transpose() + H.transpose() * H); }
  /// S, Pa.
  static Mat3 second(const Lame& m, const Mat3& E) {
    return m.lambda * E.trace() * Mat3::Identity() + 2.0 * m.mu * E;
  }
};

/// The series of the law in one integration point; carries those of E and S.            docs/design.md, Series
class StVenantKirchhoff::Series {
 public:
  PALPATE_INLINE Series(const Lame& m, const PartTensor* H, int fields) : m_(m), H_(H), fields_(fields) {}

  /// E_k = sum H_b^T H_c / 2 + sym H_k,  S_k = C : E_k
  PALPATE_INLINE void carry(const CauchyProduct& product, int k) {
    PartSymmetric& E = E_[static_cast<std::size_t>(k)];
    quadraticStrain(product, k, E);
    if (k < fields_) addSym(H_[k], E);
    stressOf(E, S_[static_cast<std::size_t>(k)]);
  }

  /// P = S'_k + sum H_b S_c,  S'_k = C : sum H_b^T H_c / 2
  PALPATE_INLINE void lowerOrders(const CauchyProduct& product, int k, PartTensor& P) const {
    PartSymmetric E, S;
    quadraticStrain(product, k, E);
    stressOf(E, S);
    asTensor(S, P);
    const int begin = product.begin[static_cast<std::size_t>(k)];
    const int end = product.begin[static_cast<std::size_t>(k) + 1];
    for (int p = begin; p < end; ++p) {
      const auto [b, c] = product.pairs[static_cast<std::size_t>(p)];
      addTimes(H_[b], S_[static_cast<std::size_t>(c)], P);
      if (b != c) addTimes(H_[c], S_[static_cast<std::size_t>(b)], P);
    }
  }

  /// W_k = sum E_b : S_c / 2, b and c in both orders: a pair of equal factors counts half.
  PALPATE_INLINE void energy(const CauchyProduct& product, int k, Part& W) const {
    PartSymmetric sum{};
    const int begin = product.begin[static_cast<std::size_t>(k)];
    const int end = product.begin[static_cast<std::size_t>(k) + 1];
    for (int p = begin; p < end; ++p) {
      const auto [b, c] = product.pairs[static_cast<std::size_t>(p)];
      const Part *left = E_[static_cast<std::size_t>(b)].v, *right = S_[static_cast<std::size_t>(c)].v;
      if (b == c)
        for (int i = 0; i < 6; ++i) sum.v[i] += 0.5 * left[i] * right[i];
      else
        for (int i = 0; i < 6; ++i) sum.v[i] += left[i] * right[i];
    }
    W = ((sum.v[0] + sum.v[1]) + (sum.v[2] + sum.v[3])) + (sum.v[4] + sum.v[5]);
  }

 private:
  /// The quadratic part of E_k.
  PALPATE_INLINE void quadraticStrain(const CauchyProduct& product, int k, PartSymmetric& strain) const {
    PartSymmetric t{};
    const int begin = product.begin[static_cast<std::size_t>(k)];
    const int end = product.begin[static_cast<std::size_t>(k) + 1];
    for (int p = begin; p < end; ++p) {
      const auto [b, c] = product.pairs[static_cast<std::size_t>(p)];
      if (b == c)
        addSquare(H_[b], t);
      else
        addProduct(H_[b], H_[c], t);
    }
    for (int i = 0; i < 6; ++i) strain.v[i] = t.v[i];
  }

  PALPATE_INLINE void stressOf(const PartSymmetric& strain, PartSymmetric& stress) const {
    const Part pressure = m_.lambda * (strain.v[0] + strain.v[1] + strain.v[2]);
    for (int i = 0; i < 3; ++i) stress.v[i] = 2.0 * m_.mu * strain.v[i] + pressure;
    for (int i = 3; i < 6; ++i) stress.v[i] = m_.mu * strain.v[i];
  }

  static constexpr std::size_t kMost = MonomialBasis::kMaxCoefficients;
  const Lame m_;
  const PartTensor* const H_;
  const int fields_;
  std::array<PartSymmetric, kMost> E_, S_;
};

}  // namespace palpate::solver
