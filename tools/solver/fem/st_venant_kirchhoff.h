// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
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

  static void check(const Elasticity& e) { e.requireSolid(); }

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
  class EnergySeries;

 private:
  template <typename Scalar>
  static void quadraticStrain(const CauchyProduct& product, int k, const Tensor<Scalar>* H,
                              Symmetric<Scalar>& E);
  static Mat3 strain(const Mat3& H) { return 0.5 * (H + H.transpose() + H.transpose() * H); }
  /// S, Pa.
  static Mat3 second(const Lame& m, const Mat3& E) {
    return m.lambda * E.trace() * Mat3::Identity() + 2.0 * m.mu * E;
  }
};

/// E += sum H_b^T H_c / 2 over the pairs of coefficient k.
template <typename Scalar>
PALPATE_INLINE void StVenantKirchhoff::quadraticStrain(const CauchyProduct& product, int k,
                                                       const Tensor<Scalar>* H, Symmetric<Scalar>& E) {
  Tensor<Scalar> mixed{};
  const int begin = product.factors[static_cast<std::size_t>(k)];
  const int end = product.begin[static_cast<std::size_t>(k) + 1];
  for (int p = begin; p < end; ++p) {
    const auto [b, c] = product.pairs[static_cast<std::size_t>(p)];
    if (b == c)
      addSquare(H[b], E);
    else
      addTransposeTimes(H[b], H[c], mixed);  // half of this and half of its transpose
  }
  addSym(mixed, E);
}

/// The series of P in one integration point; carries that of S.                         docs/design.md, Series
class StVenantKirchhoff::Series {
 public:
  PALPATE_INLINE Series(const Lame& m, const PartTensor* H, int fields) : m_(m), H_(H), fields_(fields) {}

  /// S_k = C : E_k,  E_k = sum H_b^T H_c / 2 + sym H_k
  PALPATE_INLINE void carry(const CauchyProduct& product, int k) {
    PartSymmetric E{};
    quadraticStrain(product, k, H_, E);
    if (k < fields_) addSym(H_[k], E);
    stressOf(E, S_[static_cast<std::size_t>(k)]);
  }

  /// P = S'_k + sum H_b S_c,  S'_k = C : sum H_b^T H_c / 2
  PALPATE_INLINE void lowerOrders(const CauchyProduct& product, int k, PartTensor& P) const {
    PartSymmetric E{}, S;
    quadraticStrain(product, k, H_, E);
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

 private:
  PALPATE_INLINE void stressOf(const PartSymmetric& strain, PartSymmetric& stress) const {
    const Part pressure = m_.lambda * (strain.v[0] + strain.v[1] + strain.v[2]);
    for (int i = 0; i < 3; ++i) stress.v[i] = 2.0 * m_.mu * strain.v[i] + pressure;
    for (int i = 3; i < 6; ++i) stress.v[i] = m_.mu * strain.v[i];
  }

  static constexpr std::size_t kMost = MonomialBasis::kMaxCoefficients;
  const Lame m_;
  const PartTensor* const H_;
  const int fields_;
  std::array<PartSymmetric, kMost> S_;
};

/// The series of W in one integration point; carries that of R = C^1/2 : E, since W = R : R / 2.
class StVenantKirchhoff::EnergySeries {
 public:
  PALPATE_INLINE EnergySeries(const Lame& m, const Tensor<float>* H, int fields)
      : normal_(static_cast<float>(std::sqrt(2.0 * m.mu))),
        shear_(static_cast<float>(std::sqrt(m.mu))),
        volume_(static_cast<float>((std::sqrt(3.0 * m.lambda + 2.0 * m.mu) - std::sqrt(2.0 * m.mu)) / 3.0)),
        H_(H),
        fields_(fields) {}

  /// R_k, in a basis in which R : R is a sum of six.
  PALPATE_INLINE void carry(const CauchyProduct& product, int k) {
    Symmetric<float> E{};
    quadraticStrain(product, k, H_, E);
    if (k < fields_) addSym(H_[k], E);
    Symmetric<float>& R = R_[static_cast<std::size_t>(k)];
    const FloatLanes pressure = volume_ * (E.v[0] + E.v[1] + E.v[2]);
    for (int i = 0; i < 3; ++i) R.v[i] = normal_ * E.v[i] + pressure;
    for (int i = 3; i < 6; ++i) R.v[i] = shear_ * E.v[i];
  }

  /// W_k += weight sum R_b : R_c / 2, b and c in both orders: a pair of equal factors counts half.
  PALPATE_INLINE void addEnergies(const CauchyRows& rows, float weight, FloatLanes* W) const {
    for (std::size_t b = 0; b + 1 < rows.begin.size(); ++b) {
      Symmetric<float> left;
      for (int i = 0; i < 6; ++i) left.v[i] = weight * R_[b].v[i];
      for (int p = rows.begin[b]; p < rows.begin[b + 1]; ++p) {
        const auto [c, k] = rows.entries[static_cast<std::size_t>(p)];
        const FloatLanes* right = R_[static_cast<std::size_t>(c)].v;
        FloatLanes sum = left.v[0] * right[0];
        for (int i = 1; i < 6; ++i) sum += left.v[i] * right[i];
        W[k] += static_cast<std::size_t>(c) == b ? 0.5F * sum : sum;
      }
    }
  }

 private:
  static constexpr std::size_t kMost = MonomialBasis::kMaxCoefficients;
  const float normal_, shear_, volume_;  // Pa^1/2
  const Tensor<float>* const H_;
  const int fields_;
  std::array<Symmetric<float>, kMost> R_;
};

}  // namespace palpate::solver
