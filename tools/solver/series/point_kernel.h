// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <variant>

#include "core/base/multi_index.h"
#include "tools/solver/base/cauchy_product.h"
#include "tools/solver/base/lanes.h"
#include "tools/solver/base/part_tensors.h"
#include "tools/solver/fem/integration_point.h"
#include "tools/solver/fem/material.h"

namespace palpate::solver {

/// Input of the kernels. U holds all coefficients of all nodes, [node][k][3] lanes.
template <int N>
struct PointInput {
  const IntegrationPoint<N>* points;
  int point_count;
  int coefficients;  ///< stride of U
  const Lanes* U;
  Law law;
};

// What the kernels of series_kernel.h do with one part of one integration point, for elements of any number of nodes.
// The compiler inlines all of it into their multiversioned entry points.
namespace point_kernel {

constexpr std::size_t kMost = MonomialBasis::kMaxCoefficients;

/// dN_a/dX_J, 1/m.
template <int N>
PALPATE_INLINE double slope(const IntegrationPoint<N>& point, std::size_t a, std::size_t J) {
  return point.gradients.data()[J * std::size_t{N} + a];
}

/// H = sum u_a (x) grad N_a; component i of node a at u[a][stride i].
template <int N>
PALPATE_INLINE void gradientOf(const IntegrationPoint<N>& point, const Part* const (&u)[N], int stride,
                               PartTensor& H) {
  for (int i = 0; i < 3; ++i) {
    Part row[3] = {};
    for (std::size_t a = 0; a < N; ++a) {
      const Part x = u[a][stride * i];
      for (std::size_t J = 0; J < 3; ++J) row[J] += x * slope(point, a, J);
    }
    for (int J = 0; J < 3; ++J) H.v[3 * i + J] = row[J];
  }
}

/// The part of each node's coefficients, [k][3] with a stride of kParts.
template <int N>
PALPATE_INLINE void nodesOf(const PointInput<N>& input, const IntegrationPoint<N>& point, int part,
                            const Part* (&u)[N]) {
  for (std::size_t a = 0; a < N; ++a)
    u[a] = &partOf(input.U[static_cast<std::ptrdiff_t>(point.nodes[a]) * input.coefficients * 3], part);
}

template <int N>
PALPATE_INLINE void gradientsOf(const PointInput<N>& input, const IntegrationPoint<N>& point, int part,
                                int count, PartTensor* H) {
  const Part* u[N];
  nodesOf(input, point, part, u);
  for (int k = 0; k < count; ++k) {
    gradientOf(point, u, kParts, H[k]);
    for (const Part*& x : u) x += 3 * kParts;
  }
}

template <int N>
PALPATE_INLINE void scatter(const IntegrationPoint<N>& point, const PartTensor& P, int part, int count,
                            int column, Lanes* r) {
  for (std::size_t a = 0; a < N; ++a) {
    const double g0 = point.weight * slope(point, a, 0), g1 = point.weight * slope(point, a, 1),
                 g2 = point.weight * slope(point, a, 2);
    Lanes* out = r + (static_cast<std::ptrdiff_t>(point.nodes[a]) * count + column) * 3;
    for (int i = 0; i < 3; ++i)
      partOf(out[i], part) += P.v[3 * i] * g0 + P.v[3 * i + 1] * g1 + P.v[3 * i + 2] * g2;
  }
}

/// One part of one point's assembleDegree.
template <typename L, int N>
PALPATE_INLINE void assemblePart(const PointInput<N>& input, const CauchyProduct& product, int n, int part,
                                 int first, int last, Lanes* r) {
  std::array<PartTensor, kMost> H;
  const IntegrationPoint<N>& point = input.points[n];
  gradientsOf(input, point, part, first, H.data());
  typename L::Series series(point.lame, H.data(), first);
  for (int k = 0; k < first; ++k) series.carry(product, k);
  for (int k = first; k < last; ++k) {
    PartTensor P;
    series.lowerOrders(product, k, P);
    scatter(point, P, part, last - first, k - first, r);
  }
}

/// One part of one point's energyCoefficients.
template <typename L, int N>
PALPATE_INLINE void energyPart(const PointInput<N>& input, const CauchyProduct& strain,
                               const CauchyProduct& energy, int n, int part, int first, int last, Lanes* W) {
  std::array<PartTensor, kMost> H;
  const IntegrationPoint<N>& point = input.points[n];
  gradientsOf(input, point, part, input.coefficients, H.data());
  typename L::Series series(point.lame, H.data(), input.coefficients);
  const int strains = static_cast<int>(strain.begin.size()) - 1;
  for (int k = 0; k < strains; ++k) series.carry(strain, k);
  for (int k = first; k < last; ++k) {
    Part density;
    series.energy(energy, k, density);
    partOf(W[k - first], part) += point.weight * density;
  }
}

/// One part of detF. F is linear in the nodes' displacements, so it sums those and not the gradients.
template <int N>
PALPATE_INLINE void detPart(const PointInput<N>& input, int n, int part, const Lanes* monomials, Lanes* det) {
  const IntegrationPoint<N>& point = input.points[n];
  const Part* u[N];
  nodesOf(input, point, part, u);
  Part moved[N][3];
  const Part* at[N];
  for (int a = 0; a < N; ++a) {
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
    at[a] = moved[a];
  }
  PartTensor F;
  gradientOf(point, at, 1, F);
  for (int i = 0; i < 9; i += 4) F.v[i] += 1.0;
  const Part* f = F.v;
  partOf(*det, part) = f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
                       f[2] * (f[3] * f[7] - f[4] * f[6]);
}

/// One part of one point's gradientBounds.
template <int N>
PALPATE_INLINE void boundPart(const PointInput<N>& input, int n, int part, const Lanes* powers,
                              Lanes* bounds) {
  const IntegrationPoint<N>& point = input.points[n];
  const Part* u[N];
  nodesOf(input, point, part, u);
  Part bound{};
  for (int k = 0; k < input.coefficients; ++k) {
    PartTensor H;
    gradientOf(point, u, kParts, H);
    for (const Part*& x : u) x += 3 * kParts;
    Part square{}, root;
    for (const Part& h : H.v) square += h * h;
    for (std::size_t lane = 0; lane < sizeof(Part) / sizeof(double); ++lane)
      root[lane] = std::sqrt(square[lane]);
    bound += partOf(powers[k], part) * root;
  }
  partOf(bounds[n], part) = bound;
}

/// Calls body with the law; std::visit would not be inlined. @param body  inlined as well
template <std::size_t I = 0, typename Body>
PALPATE_INLINE void withLaw(const Law& law, const Body& body) {
  if constexpr (I < std::variant_size_v<Law>) {
    if (law.index() == I)
      body(std::variant_alternative_t<I, Law>{});
    else
      withLaw<I + 1>(law, body);
  }
}

/// assembleDegree of series_kernel.h.
template <int N>
PALPATE_INLINE void assembleAll(const PointInput<N>& input, const CauchyProduct& product, int first, int last,
                                Lanes* r) {
  withLaw(
      input.law, [&](auto law) __attribute__((always_inline)) {
        for (int n = 0; n < input.point_count; ++n)
          for (int part = 0; part < kParts; ++part)
            assemblePart<decltype(law)>(input, product, n, part, first, last, r);
      });
}

/// energyCoefficients of series_kernel.h.
template <int N>
PALPATE_INLINE void energyAll(const PointInput<N>& input, const CauchyProduct& strain,
                              const CauchyProduct& energy, int first, int last, Lanes* W) {
  withLaw(
      input.law, [&](auto law) __attribute__((always_inline)) {
        for (int n = 0; n < input.point_count; ++n)
          for (int part = 0; part < kParts; ++part)
            energyPart<decltype(law)>(input, strain, energy, n, part, first, last, W);
      });
}

}  // namespace point_kernel

}  // namespace palpate::solver
