// SPDX-License-Identifier: Apache-2.0
#include "series_kernel.h"

#include <algorithm>
#include <cmath>

namespace palpate::offline {

namespace {

// Everything below is inlined into the multiversioned entry points, so that each is built whole for its
// target.
#define PALPATE_INLINE [[gnu::always_inline]] inline

constexpr std::size_t kMost = MonomialBasis::kMaxCoefficients;

struct Tensor {  // general 3 x 3, row-major
  Lanes v[9];
};
struct Symmetric {  // xx yy zz yz xz xy
  Lanes v[6];
};

PALPATE_INLINE void gradientOf(const KernelElement& e, const Lanes* U, int stride, int k, Tensor& H) {
  for (Lanes& h : H.v) h = Lanes{};
  for (std::size_t a = 0; a < 4; ++a) {
    const Lanes* u = U + (static_cast<std::ptrdiff_t>(e.nodes[a]) * stride + k) * 3;
    for (int i = 0; i < 3; ++i)
      for (std::size_t J = 0; J < 3; ++J) H.v[3 * i + static_cast<int>(J)] += u[i] * e.gradients[a][J];
  }
}

/// t += weight * (A^T B + B^T A)
PALPATE_INLINE void addProduct(const Tensor& A, const Tensor& B, double weight, Symmetric& t) {
  for (int i = 0; i < 3; ++i) {
    const Lanes *a = A.v + 3 * i, *b = B.v + 3 * i;
    t.v[0] += 2.0 * weight * (a[0] * b[0]);
    t.v[1] += 2.0 * weight * (a[1] * b[1]);
    t.v[2] += 2.0 * weight * (a[2] * b[2]);
    t.v[3] += weight * (a[1] * b[2] + b[1] * a[2]);
    t.v[4] += weight * (a[0] * b[2] + b[0] * a[2]);
    t.v[5] += weight * (a[0] * b[1] + b[0] * a[1]);
  }
}

PALPATE_INLINE void addSym(const Tensor& H, Symmetric& t) {
  t.v[0] += H.v[0];
  t.v[1] += H.v[4];
  t.v[2] += H.v[8];
  t.v[3] += 0.5 * (H.v[5] + H.v[7]);
  t.v[4] += 0.5 * (H.v[2] + H.v[6]);
  t.v[5] += 0.5 * (H.v[1] + H.v[3]);
}

PALPATE_INLINE void stressOf(Symmetric& t, double lambda, double mu) {
  const Lanes pressure = lambda * (t.v[0] + t.v[1] + t.v[2]);
  for (Lanes& x : t.v) x = 2.0 * mu * x;
  for (int i = 0; i < 3; ++i) t.v[i] += pressure;
}

/// P += H S
PALPATE_INLINE void addTimes(const Tensor& H, const Symmetric& S, Tensor& P) {
  for (int i = 0; i < 3; ++i) {
    const Lanes* h = H.v + 3 * i;
    P.v[3 * i] += h[0] * S.v[0] + h[1] * S.v[5] + h[2] * S.v[4];
    P.v[3 * i + 1] += h[0] * S.v[5] + h[1] * S.v[1] + h[2] * S.v[3];
    P.v[3 * i + 2] += h[0] * S.v[4] + h[1] * S.v[3] + h[2] * S.v[2];
  }
}

PALPATE_INLINE void addSymmetric(const Symmetric& S, Tensor& P) {
  P.v[0] += S.v[0];
  P.v[4] += S.v[1];
  P.v[8] += S.v[2];
  P.v[5] += S.v[3];
  P.v[7] += S.v[3];
  P.v[2] += S.v[4];
  P.v[6] += S.v[4];
  P.v[1] += S.v[5];
  P.v[3] += S.v[5];
}

/// Sum over the pairs of one coefficient of (H_b^T H_c)-symmetrized: the quadratic part of E_alpha.
PALPATE_INLINE void quadraticStrain(const CauchyProduct& product, int k, const Tensor* H, Symmetric& t) {
  for (Lanes& x : t.v) x = Lanes{};
  const int begin = product.begin[static_cast<std::size_t>(k)],
            end = product.begin[static_cast<std::size_t>(k) + 1];
  for (int p = begin; p < end; ++p) {
    const auto [b, c] = product.pairs[static_cast<std::size_t>(p)];
    addProduct(H[b], H[c], b == c ? 0.25 : 0.5, t);
  }
}

PALPATE_INLINE void scatter(const KernelElement& e, const Tensor& P, int count, int column, Lanes* r) {
  for (std::size_t a = 0; a < 4; ++a) {
    const double g0 = e.volume * e.gradients[a][0], g1 = e.volume * e.gradients[a][1],
                 g2 = e.volume * e.gradients[a][2];
    Lanes* out = r + (static_cast<std::ptrdiff_t>(e.nodes[a]) * count + column) * 3;
    for (int i = 0; i < 3; ++i) out[i] += P.v[3 * i] * g0 + P.v[3 * i + 1] * g1 + P.v[3 * i + 2] * g2;
  }
}

}  // namespace

CauchyProduct::CauchyProduct(const MonomialBasis& basis, int factor_order) {
  const int factors = std::min(basis.size(), MonomialBasis::size(factor_order));
  begin.push_back(0);
  for (int k = 0; k < basis.size(); ++k) {
    for (int b = 0; b < factors; ++b) {
      const int c =
          basis.find({basis[k][0] - basis[b][0], basis[k][1] - basis[b][1], basis[k][2] - basis[b][2]});
      if (c >= b && c < factors) pairs.push_back({b, c});
    }
    begin.push_back(static_cast<int>(pairs.size()));
  }
}

PALPATE_MULTIVERSION
void assembleDegree(const KernelInput& input, const CauchyProduct& product, int first, int last, Lanes* r) {
  std::array<Tensor, kMost> H;
  std::array<Symmetric, kMost> S;
  for (int n = 0; n < input.element_count; ++n) {
    const KernelElement& e = input.elements[n];
    for (int k = 0; k < first; ++k)
      gradientOf(e, input.U, input.coefficients, k, H[static_cast<std::size_t>(k)]);
    for (int k = 0; k < first; ++k) {
      Symmetric& t = S[static_cast<std::size_t>(k)];
      quadraticStrain(product, k, H.data(), t);
      addSym(H[static_cast<std::size_t>(k)], t);
      stressOf(t, input.lambda, input.mu);
    }
    for (int k = first; k < last; ++k) {
      Symmetric t;
      quadraticStrain(product, k, H.data(), t);
      stressOf(t, input.lambda, input.mu);
      Tensor P{};
      addSymmetric(t, P);
      const int begin = product.begin[static_cast<std::size_t>(k)];
      const int end = product.begin[static_cast<std::size_t>(k) + 1];
      for (int p = begin; p < end; ++p) {
        const auto [b, c] = product.pairs[static_cast<std::size_t>(p)];
        addTimes(H[static_cast<std::size_t>(b)], S[static_cast<std::size_t>(c)], P);
        if (b != c) addTimes(H[static_cast<std::size_t>(c)], S[static_cast<std::size_t>(b)], P);
      }
      scatter(e, P, last - first, k - first, r);
    }
  }
}

PALPATE_MULTIVERSION
void energyCoefficients(const KernelInput& input, const CauchyProduct& strain, const CauchyProduct& energy,
                        int first, int last, Lanes* W) {
  std::array<Tensor, kMost> H;
  std::array<Symmetric, kMost> E;
  std::array<Symmetric, kMost> S;  // shear doubled: E : S is then a sum of six
  const int strains = static_cast<int>(strain.begin.size()) - 1;
  for (int n = 0; n < input.element_count; ++n) {
    const KernelElement& e = input.elements[n];
    for (int k = 0; k < input.coefficients; ++k)
      gradientOf(e, input.U, input.coefficients, k, H[static_cast<std::size_t>(k)]);
    for (int k = 0; k < strains; ++k) {
      Symmetric& t = E[static_cast<std::size_t>(k)];
      quadraticStrain(strain, k, H.data(), t);
      if (k < input.coefficients) addSym(H[static_cast<std::size_t>(k)], t);
      Symmetric& stress = S[static_cast<std::size_t>(k)];
      stress = t;
      stressOf(stress, input.lambda, input.mu);
      for (int shear = 3; shear < 6; ++shear) stress.v[shear] *= 2.0;
    }
    for (int k = first; k < last; ++k) {
      Lanes sum{};
      const int begin = energy.begin[static_cast<std::size_t>(k)],
                end = energy.begin[static_cast<std::size_t>(k) + 1];
      for (int p = begin; p < end; ++p) {
        const auto [b, c] = energy.pairs[static_cast<std::size_t>(p)];
        const Symmetric &left = E[static_cast<std::size_t>(b)], &right = S[static_cast<std::size_t>(c)];
        Lanes product = left.v[0] * right.v[0];
        for (int i = 1; i < 6; ++i) product += left.v[i] * right.v[i];
        sum += b == c ? 0.5 * product : product;
      }
      W[k - first] += e.volume * sum;
    }
  }
}

PALPATE_MULTIVERSION
void detF(const KernelInput& input, int element, const Lanes* monomials, Lanes* det) {
  Tensor F{};
  for (int k = 0; k < input.coefficients; ++k) {
    Tensor H;
    gradientOf(input.elements[element], input.U, input.coefficients, k, H);
    for (int i = 0; i < 9; ++i) F.v[i] += monomials[k] * H.v[i];
  }
  for (int i = 0; i < 9; i += 4) F.v[i] += 1.0;
  const Lanes* f = F.v;
  *det = f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
         f[2] * (f[3] * f[7] - f[4] * f[6]);
}

PALPATE_MULTIVERSION
void gradientBounds(const KernelInput& input, const Lanes* powers, Lanes* bounds) {
  for (int n = 0; n < input.element_count; ++n) {
    Lanes bound{};
    for (int k = 0; k < input.coefficients; ++k) {
      Tensor H;
      gradientOf(input.elements[n], input.U, input.coefficients, k, H);
      Lanes square{};
      for (const Lanes& h : H.v) square += h * h;
      for (int lane = 0; lane < kLanes; ++lane) bound[lane] += powers[k][lane] * std::sqrt(square[lane]);
    }
    bounds[n] = bound;
  }
}

}  // namespace palpate::offline
