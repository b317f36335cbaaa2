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

/// Input of the kernels. U and V hold all coefficients of all nodes, [node][k][3] lanes.
template <int N>
struct PointInput {
  const IntegrationPoint<N>* points;
  int point_count;
  int coefficients;     ///< stride of U and V
  const Lanes* U;       ///< U_alpha
  const FloatLanes* V;  ///< U_alpha length^|alpha|, for energies and bounds
  double length;        ///< of an element's size, m (driven by force: N): numbers near 1 for float32
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

/// dN_a/dX_J in the precision of a kernel.
template <typename Scalar, int N>
struct Slopes {
  Scalar v[N][3];
};
template <typename Scalar, int N>
PALPATE_INLINE void slopesOf(const IntegrationPoint<N>& point, Slopes<Scalar, N>& g) {
  for (std::size_t a = 0; a < N; ++a)
    for (std::size_t J = 0; J < 3; ++J) g.v[a][J] = static_cast<Scalar>(slope(point, a, J));
}

/// H = sum u_a (x) grad N_a; component i of node a at u[a][stride i].
template <typename Scalar, int N>
PALPATE_INLINE void gradientOf(const Slopes<Scalar, N>& g,
                               const typename RegisterOf<Scalar>::Type* const (&u)[N], int stride,
                               Tensor<Scalar>& H) {
  for (int i = 0; i < 3; ++i) {
    typename RegisterOf<Scalar>::Type row[3] = {};
    for (std::size_t a = 0; a < N; ++a) {
      const auto& x = u[a][stride * i];
      for (std::size_t J = 0; J < 3; ++J) row[J] += x * g.v[a][J];
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

/// H_k of the first `count` coefficients.
template <int N>
PALPATE_INLINE void gradientsOf(const PointInput<N>& input, const IntegrationPoint<N>& point, int part,
                                int count, PartTensor* H) {
  const Part* u[N];
  nodesOf(input, point, part, u);
  Slopes<double, N> g;
  slopesOf(point, g);
  for (int k = 0; k < count; ++k) {
    gradientOf(g, u, kParts, H[k]);
    for (const Part*& x : u) x += 3 * kParts;
  }
}

/// H_k length^|alpha_k| of the first `count` coefficients.
template <int N>
PALPATE_INLINE void scaledGradientsOf(const PointInput<N>& input, const IntegrationPoint<N>& point, int count,
                                      Tensor<float>* H) {
  const FloatLanes* u[N];
  for (std::size_t a = 0; a < N; ++a)
    u[a] = input.V + static_cast<std::ptrdiff_t>(point.nodes[a]) * input.coefficients * 3;
  Slopes<float, N> g;
  slopesOf(point, g);
  for (int k = 0; k < count; ++k) {
    gradientOf(g, u, 1, H[k]);
    for (const FloatLanes*& x : u) x += 3;
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

/// One point's energyCoefficients.
template <typename L, int N>
PALPATE_INLINE void energyPoint(const PointInput<N>& input, int fields, const CauchyProduct& factors,
                                const CauchyRows& rows, int n, FloatLanes* W) {
  std::array<Tensor<float>, kMost> H;
  const IntegrationPoint<N>& point = input.points[n];
  scaledGradientsOf(input, point, fields, H.data());
  typename L::EnergySeries series(point.lame, H.data(), fields);
  const int carried = static_cast<int>(factors.begin.size()) - 1;
  for (int k = 0; k < carried; ++k) series.carry(factors, k);
  series.addEnergies(rows, static_cast<float>(point.weight), W);
}

/// One part of det F of one point, of fields that are already summed: one coefficient.
template <int N>
PALPATE_INLINE void detPart(const PointInput<N>& summed, int n, int part, Part& det) {
  PartTensor F;
  gradientsOf(summed, summed.points[n], part, 1, &F);
  for (int i = 0; i < 9; i += 4) F.v[i] += 1.0;
  const Part* f = F.v;
  det = f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
        f[2] * (f[3] * f[7] - f[4] * f[6]);
}

/// One point's gradientBounds.
template <int N>
PALPATE_INLINE void boundPoint(const PointInput<N>& input, int n, const FloatLanes* powers,
                               FloatLanes& bound) {
  std::array<Tensor<float>, kMost> H;
  scaledGradientsOf(input, input.points[n], input.coefficients, H.data());
  bound = FloatLanes{};
  for (int k = 0, degree = 1; k < input.coefficients; ++degree) {
    FloatLanes square{}, root;
    for (; k < input.coefficients && k < MonomialBasis::begin(degree + 1); ++k)
      for (const FloatLanes& h : H[static_cast<std::size_t>(k)].v) square += h * h;
    for (int lane = 0; lane < kLanes; ++lane) root[lane] = std::sqrt(square[lane]);
    bound += powers[degree - 1] * root;
  }
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

/// Calls body(law, first, end) for each run of points with one law. @param body  inlined as well
template <int N, typename Body>
PALPATE_INLINE void forRuns(const PointInput<N>& input, const Body& body) {
  const IntegrationPoint<N>* const end = input.points + input.point_count;
  for (const IntegrationPoint<N>* first = input.points; first != end;) {
    const IntegrationPoint<N>* const last = endOfRun(first, end);
    withLaw(
        first->law, [&](auto law) __attribute__((always_inline)) {
          body(law, static_cast<int>(first - input.points), static_cast<int>(last - input.points));
        });
    first = last;
  }
}

/// assembleDegree of series_kernel.h.
template <int N>
PALPATE_INLINE void assembleAll(const PointInput<N>& input, const CauchyProduct& product, int first, int last,
                                Lanes* r) {
  forRuns(
      input, [&](auto law, int from, int to) __attribute__((always_inline)) {
        for (int n = from; n < to; ++n)
          for (int part = 0; part < kParts; ++part)
            assemblePart<decltype(law)>(input, product, n, part, first, last, r);
      });
}

/// energyCoefficients of series_kernel.h.
template <int N>
PALPATE_INLINE void energyAll(const PointInput<N>& input, int fields, const CauchyProduct& factors,
                              const CauchyRows& rows, int count, Lanes* W) {
  constexpr int kBlock = 16;  // points summed in float32
  forRuns(
      input, [&](auto law, int from, int to) __attribute__((always_inline)) {
        for (int begin = from; begin < to; begin += kBlock) {
          std::array<FloatLanes, kMost> sums;
          for (int k = 0; k < count; ++k) sums[static_cast<std::size_t>(k)] = FloatLanes{};
          for (int n = begin; n < begin + kBlock && n < to; ++n)
            energyPoint<decltype(law)>(input, fields, factors, rows, n, sums.data());
          for (int k = 0; k < count; ++k)
            for (int lane = 0; lane < kLanes; ++lane)
              W[k][lane] += static_cast<double>(sums[static_cast<std::size_t>(k)][lane]);
        }
      });
}

/// leastDetF of series_kernel.h.
template <int N>
PALPATE_INLINE void leastDetAll(const PointInput<N>& summed, Lanes& least) {
  for (int part = 0; part < kParts; ++part) {
    Part smallest = partOf(least, part);
    for (int n = 0; n < summed.point_count; ++n) {
      Part det;
      detPart(summed, n, part, det);
      smallest = det < smallest ? det : smallest;
    }
    partOf(least, part) = smallest;
  }
}

}  // namespace point_kernel

}  // namespace palpate::solver
