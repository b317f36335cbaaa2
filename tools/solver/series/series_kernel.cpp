// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/series/series_kernel.h"

#include <algorithm>
#include <cmath>

namespace palpate::solver {

namespace {

// The compiler inlines everything below into the multiversioned entry points and so builds it for each
// target.
#define PALPATE_INLINE [[gnu::always_inline]] inline

constexpr std::size_t kMost = MonomialBasis::kMaxCoefficients;

/// The lanes that one AVX2 register holds. GCC splits operations on a whole Lanes through the stack, so the
/// kernels visit each element once per part, and whole Lanes are in memory only.
using Part [[gnu::vector_size(4 * sizeof(double)), gnu::may_alias]] = double;
constexpr int kParts = sizeof(Lanes) / sizeof(Part);
static_assert(sizeof(Lanes) % sizeof(Part) == 0);

PALPATE_INLINE const Part& partOf(const Lanes& x, int part) {
  return reinterpret_cast<const Part*>(&x)[part];
}
PALPATE_INLINE Part& partOf(Lanes& x, int part) {
  return reinterpret_cast<Part*>(&x)[part];
}

struct Tensor {  // general 3 x 3, row-major
  Part v[9];
};
/// xx yy zz yz xz xy. Strains hold twice the shear, stresses once: S : E is then a sum of six.
struct Symmetric {
  Part v[6];
};

/// H = sum u_a (x) grad N_a; component i of corner a at u[a][stride i].
PALPATE_INLINE void gradientOf(const KernelElement& e, const Part* const (&u)[4], int stride, Tensor& H) {
  for (int i = 0; i < 3; ++i) {
    Part row[3] = {};
    for (std::size_t a = 0; a < 4; ++a) {
      const Part x = u[a][stride * i];
      for (std::size_t J = 0; J < 3; ++J) row[J] += x * e.gradients[a][J];
    }
    for (int J = 0; J < 3; ++J) H.v[3 * i + J] = row[J];
  }
}

/// The part of each corner's coefficients, [k][3] with a stride of kParts.
PALPATE_INLINE void corners(const KernelInput& input, const KernelElement& e, int part, const Part* (&u)[4]) {
  for (std::size_t a = 0; a < 4; ++a)
    u[a] = &partOf(input.U[static_cast<std::ptrdiff_t>(e.nodes[a]) * input.coefficients * 3], part);
}

PALPATE_INLINE void gradientsOf(const KernelInput& input, const KernelElement& e, int part, int count,
                                Tensor* H) {
  const Part* u[4];
  corners(input, e, part, u);
  for (int k = 0; k < count; ++k) {
    gradientOf(e, u, kParts, H[k]);
    for (const Part*& x : u) x += 3 * kParts;
  }
}

/// t += (A^T B + B^T A) / 2, with twice the shear.
PALPATE_INLINE void addProduct(const Tensor& A, const Tensor& B, Symmetric& t) {
  for (int i = 0; i < 3; ++i) {
    const Part *a = A.v + 3 * i, *b = B.v + 3 * i;
    for (int J = 0; J < 3; ++J) t.v[J] += a[J] * b[J];
    t.v[3] += a[1] * b[2];
    t.v[3] += b[1] * a[2];
    t.v[4] += a[0] * b[2];
    t.v[4] += b[0] * a[2];
    t.v[5] += a[0] * b[1];
    t.v[5] += b[0] * a[1];
  }
}

/// t += A^T A / 2, with twice the shear.
PALPATE_INLINE void addSquare(const Tensor& A, Symmetric& t) {
  for (int i = 0; i < 3; ++i) {
    const Part* a = A.v + 3 * i;
    for (int J = 0; J < 3; ++J) t.v[J] += 0.5 * a[J] * a[J];
    t.v[3] += a[1] * a[2];
    t.v[4] += a[0] * a[2];
    t.v[5] += a[0] * a[1];
  }
}

PALPATE_INLINE void addSym(const Tensor& H, Symmetric& t) {
  for (int J = 0; J < 3; ++J) t.v[J] += H.v[4 * J];
  t.v[3] += H.v[5] + H.v[7];
  t.v[4] += H.v[2] + H.v[6];
  t.v[5] += H.v[1] + H.v[3];
}

PALPATE_INLINE void stressOf(const Symmetric& strain, double lambda, double mu, Symmetric& stress) {
  const Part pressure = lambda * (strain.v[0] + strain.v[1] + strain.v[2]);
  for (int i = 0; i < 3; ++i) stress.v[i] = 2.0 * mu * strain.v[i] + pressure;
  for (int i = 3; i < 6; ++i) stress.v[i] = mu * strain.v[i];
}

/// P += H S
PALPATE_INLINE void addTimes(const Tensor& H, const Symmetric& S, Tensor& P) {
  for (int i = 0; i < 3; ++i) {
    const Part* h = H.v + 3 * i;
    P.v[3 * i] += h[0] * S.v[0] + h[1] * S.v[5] + h[2] * S.v[4];
    P.v[3 * i + 1] += h[0] * S.v[5] + h[1] * S.v[1] + h[2] * S.v[3];
    P.v[3 * i + 2] += h[0] * S.v[4] + h[1] * S.v[3] + h[2] * S.v[2];
  }
}

PALPATE_INLINE void asTensor(const Symmetric& S, Tensor& P) {
  constexpr int kAt[9] = {0, 5, 4, 5, 1, 3, 4, 3, 2};
  for (int i = 0; i < 9; ++i) P.v[i] = S.v[kAt[i]];
}

/// Sum over the pairs of one coefficient of (H_b^T H_c)-symmetrized: the quadratic part of E_alpha.
PALPATE_INLINE void quadraticStrain(const CauchyProduct& product, int k, const Tensor* H, Symmetric& strain) {
  Symmetric t{};
  const int begin = product.begin[static_cast<std::size_t>(k)],
            end = product.begin[static_cast<std::size_t>(k) + 1];
  for (int p = begin; p < end; ++p) {
    const auto [b, c] = product.pairs[static_cast<std::size_t>(p)];
    if (b == c)
      addSquare(H[b], t);
    else
      addProduct(H[b], H[c], t);
  }
  for (int i = 0; i < 6; ++i) strain.v[i] = t.v[i];
}

PALPATE_INLINE void scatter(const KernelElement& e, const Tensor& P, int part, int count, int column,
                            Lanes* r) {
  for (std::size_t a = 0; a < 4; ++a) {
    const double g0 = e.volume * e.gradients[a][0], g1 = e.volume * e.gradients[a][1],
                 g2 = e.volume * e.gradients[a][2];
    Lanes* out = r + (static_cast<std::ptrdiff_t>(e.nodes[a]) * count + column) * 3;
    for (int i = 0; i < 3; ++i)
      partOf(out[i], part) += P.v[3 * i] * g0 + P.v[3 * i + 1] * g1 + P.v[3 * i + 2] * g2;
  }
}

/// One part of one element's assembleDegree.
PALPATE_INLINE void assemblePart(const KernelInput& input, const CauchyProduct& product, int n, int part,
                                 int first, int last, Lanes* r) {
  std::array<Tensor, kMost> H;
  std::array<Symmetric, kMost> S;
  const KernelElement& e = input.elements[n];
  gradientsOf(input, e, part, first, H.data());
  for (int k = 0; k < first; ++k) {
    Symmetric t;
    quadraticStrain(product, k, H.data(), t);
    addSym(H[static_cast<std::size_t>(k)], t);
    stressOf(t, input.lambda, input.mu, S[static_cast<std::size_t>(k)]);
  }
  for (int k = first; k < last; ++k) {
    Symmetric t, stress;
    quadraticStrain(product, k, H.data(), t);
    stressOf(t, input.lambda, input.mu, stress);
    Tensor P;
    asTensor(stress, P);
    const int begin = product.begin[static_cast<std::size_t>(k)];
    const int end = product.begin[static_cast<std::size_t>(k) + 1];
    for (int p = begin; p < end; ++p) {
      const auto [b, c] = product.pairs[static_cast<std::size_t>(p)];
      addTimes(H[static_cast<std::size_t>(b)], S[static_cast<std::size_t>(c)], P);
      if (b != c) addTimes(H[static_cast<std::size_t>(c)], S[static_cast<std::size_t>(b)], P);
    }
    scatter(e, P, part, last - first, k - first, r);
  }
}

/// sum E_b : S_c over the pairs of one coefficient; a pair of equal factors counts half.
PALPATE_INLINE Part energyOf(const CauchyProduct& energy, int k, const Symmetric* E, const Symmetric* S) {
  Symmetric sum{};
  const int begin = energy.begin[static_cast<std::size_t>(k)],
            end = energy.begin[static_cast<std::size_t>(k) + 1];
  for (int p = begin; p < end; ++p) {
    const auto [b, c] = energy.pairs[static_cast<std::size_t>(p)];
    const Part *left = E[b].v, *right = S[c].v;
    if (b == c)
      for (int i = 0; i < 6; ++i) sum.v[i] += 0.5 * left[i] * right[i];
    else
      for (int i = 0; i < 6; ++i) sum.v[i] += left[i] * right[i];
  }
  return ((sum.v[0] + sum.v[1]) + (sum.v[2] + sum.v[3])) + (sum.v[4] + sum.v[5]);
}

/// One part of one element's energyCoefficients.
PALPATE_INLINE void energyPart(const KernelInput& input, const CauchyProduct& strain,
                               const CauchyProduct& energy, int n, int part, int first, int last, Lanes* W) {
  std::array<Tensor, kMost> H;
  std::array<Symmetric, kMost> E;
  std::array<Symmetric, kMost> S;
  const KernelElement& e = input.elements[n];
  gradientsOf(input, e, part, input.coefficients, H.data());
  const int strains = static_cast<int>(strain.begin.size()) - 1;
  for (int k = 0; k < strains; ++k) {
    Symmetric& t = E[static_cast<std::size_t>(k)];
    quadraticStrain(strain, k, H.data(), t);
    if (k < input.coefficients) addSym(H[static_cast<std::size_t>(k)], t);
    stressOf(t, input.lambda, input.mu, S[static_cast<std::size_t>(k)]);
  }
  for (int k = first; k < last; ++k)
    partOf(W[k - first], part) += e.volume * energyOf(energy, k, E.data(), S.data());
}

/// One part of detF. F is linear in the corners' displacements, so it sums those and not the gradients.
PALPATE_INLINE void detPart(const KernelInput& input, int element, int part, const Lanes* monomials,
                            Lanes* det) {
  const KernelElement& e = input.elements[element];
  const Part* u[4];
  corners(input, e, part, u);
  Part moved[4][3];
  const Part* corner[4];
  for (int a = 0; a < 4; ++a) {
    Part x{}, y{}, z{};
    for (int k = 0; k < input.coefficients; ++k) {
      const Part *from = u[a] + 3 * kParts * k, power = partOf(monomials[k], part);
      x += power * from[0];
      y += power * from[kParts];
      z += power * from[2 * kParts];
    }
    moved[a][0] = x;
    moved[a][1] = y;
    moved[a][2] = z;
    corner[a] = moved[a];
  }
  Tensor F;
  gradientOf(e, corner, 1, F);
  for (int i = 0; i < 9; i += 4) F.v[i] += 1.0;
  const Part* f = F.v;
  partOf(*det, part) = f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
                       f[2] * (f[3] * f[7] - f[4] * f[6]);
}

/// One part of one element's gradientBounds.
PALPATE_INLINE void boundPart(const KernelInput& input, int n, int part, const Lanes* powers, Lanes* bounds) {
  const KernelElement& e = input.elements[n];
  const Part* u[4];
  corners(input, e, part, u);
  Part bound{};
  for (int k = 0; k < input.coefficients; ++k) {
    Tensor H;
    gradientOf(e, u, kParts, H);
    for (const Part*& x : u) x += 3 * kParts;
    Part square{}, root;
    for (const Part& h : H.v) square += h * h;
    for (std::size_t lane = 0; lane < sizeof(Part) / sizeof(double); ++lane)
      root[lane] = std::sqrt(square[lane]);
    bound += partOf(powers[k], part) * root;
  }
  partOf(bounds[n], part) = bound;
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
  for (int n = 0; n < input.element_count; ++n)
    for (int part = 0; part < kParts; ++part) assemblePart(input, product, n, part, first, last, r);
}

PALPATE_MULTIVERSION
void energyCoefficients(const KernelInput& input, const CauchyProduct& strain, const CauchyProduct& energy,
                        int first, int last, Lanes* W) {
  for (int n = 0; n < input.element_count; ++n)
    for (int part = 0; part < kParts; ++part) energyPart(input, strain, energy, n, part, first, last, W);
}

PALPATE_MULTIVERSION
void detF(const KernelInput& input, int element, const Lanes* monomials, Lanes* det) {
  for (int part = 0; part < kParts; ++part) detPart(input, element, part, monomials, det);
}

PALPATE_MULTIVERSION
void gradientBounds(const KernelInput& input, const Lanes* powers, Lanes* bounds) {
  for (int n = 0; n < input.element_count; ++n)
    for (int part = 0; part < kParts; ++part) boundPart(input, n, part, powers, bounds);
}

}  // namespace palpate::solver
