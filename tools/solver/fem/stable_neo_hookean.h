// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <string_view>

#include "core/base/multi_index.h"
#include "tools/solver/base/cauchy_product.h"
#include "tools/solver/base/part_tensors.h"
#include "tools/solver/fem/elasticity.h"

namespace palpate::solver {

/// Stable neo-Hookean, with Lame's constants of linear elasticity and k = lambda + mu:
///   Psi = mu/2 (I_C - 3) + k/2 (J - 1 - mu/k)^2 + constant,  P = mu F + (k (J - 1) - mu) cof F
/// B. Smith, F. de Goes, T. Kim, "Stable neo-Hookean flesh simulation", ACM Trans. Graph. 37 (2018) 12, without their
/// term in log(I_C + 1), so that Psi is a polynomial in F. An element that is inside out has finite energy.
/// With j = J - 1, split by degree in H so that nothing cancels near rest:
///   cof F = I + cof1 + cof H,  cof1 = tr(H) I - H^T,  j = tr H + cof1 : H / 2 + cof H : H / 3
///   Psi = mu/2 H : H + k/2 j^2 - mu (j - tr H),  P = mu H + k j cof F - mu (cof1 + cof H)
/// What each function owes is with MaterialLaw.
struct StableNeoHookean {
  using Mat3 = Eigen::Matrix3d;

  static constexpr std::string_view kName = "stable-neo-hookean";

  static void check(const Elasticity& e) { e.requireSolid(); }

  /// Two terms of *HYPERFOAM, sum_i mu_i/2 (I_C - 3 + (J^(-2 b_i) - 1) / b_i) with b_i = nu_i / (1 - 2 nu_i): of
  /// mu_1 = k + mu, b_1 = -1/2 and mu_2 = -k, b_2 = -1. No nu_1 is -1/2 exactly; 1e12 is it to 5e-13.
  static CcxMaterial ccx(const Elasticity& e) {
    const Lame m = e.lame();
    const double k = m.lambda + m.mu;
    return {"*HYPERFOAM,N=2", {k + m.mu, 2.0, -k, 2.0, 1e12, 1.0}};
  }

  static double energy(const Lame& m, const Mat3& H) {
    const double j = volumeChange(H);
    return 0.5 * m.mu * H.squaredNorm() + 0.5 * (m.lambda + m.mu) * j * j - m.mu * (j - H.trace());
  }

  static Mat3 stress(const Lame& m, const Mat3& H) {
    const Mat3 cofactor = cofactorChange(H);  // cof F - I
    const double pressure = (m.lambda + m.mu) * volumeChange(H);
    return m.mu * (H - cofactor) + pressure * (Mat3::Identity() + cofactor);
  }

  template <int N>
  static Eigen::Matrix<double, 3 * N, 3 * N> tangent(const Lame& m, const Mat3& H,
                                                     const Eigen::Matrix<double, N, 3>& g) {
    const Mat3 F = Mat3::Identity() + H;
    const Mat3 cofactor = Mat3::Identity() + cofactorChange(H);
    const double k = m.lambda + m.mu;
    const double of_cofactor = k * volumeChange(H) - m.mu;
    const Eigen::Matrix<double, N, 3> c = g * cofactor.transpose();  // row a: dJ / du_a
    Eigen::Matrix<double, 3 * N, 3 * N> K;
    for (int a = 0; a < N; ++a) {
      for (int b = 0; b < N; ++b) {
        // d2J / du_a du_b, ij: e_ijk v_k.
        const Eigen::Vector3d v = F * Eigen::Vector3d(g.row(a)).cross(Eigen::Vector3d(g.row(b)));
        Mat3 bend;
        bend << 0.0, v[2], -v[1], -v[2], 0.0, v[0], v[1], -v[0], 0.0;
        K.template block<3, 3>(3 * a, 3 * b) = k * c.row(a).transpose() * c.row(b) + of_cofactor * bend +
                                               m.mu * g.row(a).dot(g.row(b)) * Mat3::Identity();
      }
    }
    return K;
  }

  class Series;
  class EnergySeries;

 private:
  /// J - 1.
  static double volumeChange(const Mat3& H) {
    const double trace = H.trace();
    return trace + 0.5 * (trace * trace - H.cwiseProduct(H.transpose()).sum()) + H.determinant();
  }
  /// cof F - I.
  static Mat3 cofactorChange(const Mat3& H) {
    Mat3 cofactor = H.trace() * Mat3::Identity() - H.transpose();
    for (int i = 0; i < 3; ++i) cofactor.row(i) += H.row((i + 1) % 3).cross(H.row((i + 2) % 3));
    return cofactor;
  }
};

/// Quantities of one coefficient that both series are made of.
namespace neo_hookean {

/// T += scale (tr(H) I - H^T)
template <typename Scalar>
PALPATE_INLINE void addLinearCofactor(const Tensor<Scalar>& H, Scalar scale, Tensor<Scalar>& T) {
  const typename RegisterOf<Scalar>::Type trace = H.v[0] + H.v[4] + H.v[8];
  for (int i = 0; i < 3; ++i) {
    for (int J = 0; J < 3; ++J) T.v[3 * i + J] -= scale * H.v[3 * J + i];
    T.v[4 * i] += scale * trace;
  }
}

/// T += cof A
template <typename Scalar>
PALPATE_INLINE void addCofactor(const Tensor<Scalar>& A, Tensor<Scalar>& T) {
  for (int i = 0; i < 3; ++i) {
    const auto* a = A.v + 3 * ((i + 1) % 3);
    const auto* b = A.v + 3 * ((i + 2) % 3);
    for (int I = 0; I < 3; ++I) {
      const int J = (I + 1) % 3, L = (I + 2) % 3;
      T.v[3 * i + I] += a[J] * b[L] - a[L] * b[J];
    }
  }
}

/// T += cof(A + B) - cof A - cof B
template <typename Scalar>
PALPATE_INLINE void addMixedCofactor(const Tensor<Scalar>& A, const Tensor<Scalar>& B, Tensor<Scalar>& T) {
  for (int i = 0; i < 3; ++i) {
    const int j = 3 * ((i + 1) % 3), l = 3 * ((i + 2) % 3);
    for (int I = 0; I < 3; ++I) {
      const int J = (I + 1) % 3, L = (I + 2) % 3;
      auto& t = T.v[3 * i + I];
      t += A.v[j + J] * B.v[l + L];
      t -= A.v[j + L] * B.v[l + J];
      t += B.v[j + J] * A.v[l + L];
      t -= B.v[j + L] * A.v[l + J];
    }
  }
}

/// T = cof H of coefficient k.
template <typename Scalar>
PALPATE_INLINE void cofactorOf(const CauchyProduct& product, int k, const Tensor<Scalar>* H,
                               Tensor<Scalar>& T) {
  Tensor<Scalar> sum{};
  const int end = product.begin[static_cast<std::size_t>(k) + 1];
  for (int p = product.factors[static_cast<std::size_t>(k)]; p < end; ++p) {
    const auto [b, c] = product.pairs[static_cast<std::size_t>(p)];
    if (b == c)
      addCofactor(H[b], sum);
    else
      addMixedCofactor(H[b], H[c], sum);
  }
  T = sum;
}

/// sum += scale A : B
template <typename Scalar>
PALPATE_INLINE void addDot(const Tensor<Scalar>& A, const Tensor<Scalar>& B, Scalar scale,
                           typename RegisterOf<Scalar>::Type& sum) {
  typename RegisterOf<Scalar>::Type dot = A.v[0] * B.v[0];
  for (int i = 1; i < 9; ++i) dot += A.v[i] * B.v[i];
  sum += scale * dot;
}

}  // namespace neo_hookean

/// The series of P in one integration point; carries those of C = cof F - I and of j.   docs/design.md, Series
class StableNeoHookean::Series {
 public:
  PALPATE_INLINE Series(const Lame& m, const PartTensor* H, int fields)
      : mu_(m.mu), k_(m.lambda + m.mu), H_(H), fields_(fields) {}

  PALPATE_INLINE void carry(const CauchyProduct& product, int k) {
    auto& [C, j] = terms_[static_cast<std::size_t>(k)];
    neo_hookean::cofactorOf(product, k, H_, C);
    volumeOf(product, k, j);
    if (k >= fields_) return;
    neo_hookean::addLinearCofactor(H_[k], 1.0, C);
    j += H_[k].v[0] + H_[k].v[4] + H_[k].v[8];
  }

  /// P_k = k (j_k I + sum j_b C_c) - mu C_k, without the linear parts of j_k and C_k
  PALPATE_INLINE void lowerOrders(const CauchyProduct& product, int k, PartTensor& P) const {
    PartTensor C, sum{};
    Part j;
    neo_hookean::cofactorOf(product, k, H_, C);
    volumeOf(product, k, j);
    const int begin = product.begin[static_cast<std::size_t>(k)];
    const int end = product.begin[static_cast<std::size_t>(k) + 1];
    for (int p = begin; p < end; ++p) {
      const auto [b, c] = product.pairs[static_cast<std::size_t>(p)];
      const Term& left = terms_[static_cast<std::size_t>(b)];
      const Term& right = terms_[static_cast<std::size_t>(c)];
      for (int i = 0; i < 9; ++i) sum.v[i] += left.j * right.C.v[i];
      if (b != c)
        for (int i = 0; i < 9; ++i) sum.v[i] += right.j * left.C.v[i];
    }
    for (int i = 0; i < 9; i += 4) sum.v[i] += j;
    for (int i = 0; i < 9; ++i) P.v[i] = k_ * sum.v[i] - mu_ * C.v[i];
  }

 private:
  struct Term {
    PartTensor C;
    Part j;
  };

  /// j_k without tr H_k. Of degree n, after Euler, from dJ = cof F : dF:  n j_k = n tr H_k + sum deg(c) C_b : H_c
  PALPATE_INLINE void volumeOf(const CauchyProduct& product, int k, Part& j) const {
    j = Part{};
    const int begin = product.begin[static_cast<std::size_t>(k)];
    const int end = product.begin[static_cast<std::size_t>(k) + 1];
    for (int p = begin; p < end; ++p) {
      const auto [b, c] = product.pairs[static_cast<std::size_t>(p)];
      if (c < fields_)
        neo_hookean::addDot(terms_[static_cast<std::size_t>(b)].C, H_[c], degree(product, c), j);
      if (b != c) neo_hookean::addDot(terms_[static_cast<std::size_t>(c)].C, H_[b], degree(product, b), j);
    }
    j *= 1.0 / degree(product, k);
  }
  PALPATE_INLINE static double degree(const CauchyProduct& product, int k) {
    return product.degree[static_cast<std::size_t>(k)];
  }

  static constexpr std::size_t kMost = MonomialBasis::kMaxCoefficients;
  const double mu_, k_;  // Pa
  const PartTensor* const H_;
  const int fields_;
  std::array<Term, kMost> terms_;
};

/// The series of W in one integration point: W = mu/2 H : (H - 2 Q) + k/2 j^2 with Q = cof1 / 2 + cof H / 3 and
/// j = tr H + Q : H. Carries those of Q and j.
class StableNeoHookean::EnergySeries {
 public:
  PALPATE_INLINE EnergySeries(const Lame& m, const Tensor<float>* H, int fields)
      : mu_(static_cast<float>(m.mu)), k_(static_cast<float>(m.lambda + m.mu)), H_(H), fields_(fields) {}

  PALPATE_INLINE void carry(const CauchyProduct& product, int k) {
    auto& [Q, j] = terms_[static_cast<std::size_t>(k)];
    neo_hookean::cofactorOf(product, k, H_, Q);
    for (FloatLanes& q : Q.v) q *= 1.0F / 3.0F;
    j = FloatLanes{};
    const int begin = product.begin[static_cast<std::size_t>(k)];
    const int end = product.begin[static_cast<std::size_t>(k) + 1];
    for (int p = begin; p < end; ++p) {
      const auto [b, c] = product.pairs[static_cast<std::size_t>(p)];
      if (c < fields_) neo_hookean::addDot(terms_[static_cast<std::size_t>(b)].Q, H_[c], 1.0F, j);
      if (b != c) neo_hookean::addDot(terms_[static_cast<std::size_t>(c)].Q, H_[b], 1.0F, j);
    }
    if (k >= fields_) return;
    neo_hookean::addLinearCofactor(H_[k], 0.5F, Q);
    j += H_[k].v[0] + H_[k].v[4] + H_[k].v[8];
  }

  /// W_k += weight sum (mu/2 H_b : (H_c - 2 Q_c) + k/2 j_b j_c), b and c in both orders: a pair of equal factors counts
  /// half. Of two factors the one of lower degree is a field.
  PALPATE_INLINE void addEnergies(const CauchyRows& rows, float weight, FloatLanes* W) const {
    for (int b = 0; b + 1 < static_cast<int>(rows.begin.size()); ++b) {
      const Term& left = terms_[static_cast<std::size_t>(b)];
      const FloatLanes j = weight * k_ * left.j;
      Tensor<float> of_field, of_Q;
      for (int i = 0; i < 9; ++i) {
        of_Q.v[i] = -weight * mu_ * H_[b].v[i];
        of_field.v[i] = weight * mu_ * (H_[b].v[i] - left.Q.v[i]);
      }
      const int end = rows.begin[static_cast<std::size_t>(b) + 1];
      for (int p = rows.begin[static_cast<std::size_t>(b)]; p < end; ++p) {
        const auto [c, k] = rows.entries[static_cast<std::size_t>(p)];
        const Term& right = terms_[static_cast<std::size_t>(c)];
        FloatLanes sum = j * right.j;
        neo_hookean::addDot(of_Q, right.Q, 1.0F, sum);
        if (c < fields_) neo_hookean::addDot(of_field, H_[c], 1.0F, sum);
        W[k] += c == b ? 0.5F * sum : sum;
      }
    }
  }

 private:
  struct Term {
    Tensor<float> Q;
    FloatLanes j;
  };

  static constexpr std::size_t kMost = MonomialBasis::kMaxCoefficients;
  const float mu_, k_;  // Pa
  const Tensor<float>* const H_;
  const int fields_;
  std::array<Term, kMost> terms_;
};

}  // namespace palpate::solver
