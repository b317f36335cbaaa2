// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/series/series_kernel.h"

namespace palpate::solver {

namespace {

template <int N>
PALPATE_INLINE PointInput<N> inputOf(const KernelInput& input,
                                     const std::vector<IntegrationPoint<N>>& points) {
  return {points.data(), static_cast<int>(points.size()), input.coefficients, input.U, input.V, input.length};
}

/// Calls body with the input for the nodes that elements have; std::visit would not be inlined. @param body  inlined as well
template <typename Body>
PALPATE_INLINE void withPoints(const KernelInput& input, const Body& body) {
  if (const auto* linear = std::get_if<0>(input.points))
    body(inputOf(input, *linear));
  else
    body(inputOf(input, *std::get_if<1>(input.points)));
}

}  // namespace

PALPATE_MULTIVERSION
void assembleDegree(const KernelInput& input, const CauchyProduct& product, int first, int last, Lanes* r) {
  withPoints(
      input, [&](const auto& typed) __attribute__((always_inline)) {
        point_kernel::assembleAll(typed, product, first, last, r);
      });
}

PALPATE_MULTIVERSION
void energyCoefficients(const KernelInput& input, int fields, const CauchyProduct& factors,
                        const CauchyRows& rows, int count, Lanes* W) {
  withPoints(
      input, [&](const auto& typed) __attribute__((always_inline)) {
        point_kernel::energyAll(typed, fields, factors, rows, count, W);
      });
}

PALPATE_MULTIVERSION
void fieldsFromRows(std::span<const NodeRow> rows, const SolvedRows& solved, int coefficients, Lanes* U,
                    FloatLanes* V) {
  using FloatPart [[gnu::vector_size(sizeof(FloatLanes) / kParts), gnu::may_alias]] = float;
  const int count = solved.last - solved.first;
  const Lanes* v = solved.v;
  for (const NodeRow& row : rows) {
    const std::size_t begin = row.place * static_cast<std::size_t>(coefficients) * 3 + row.c;
    for (int part = 0; part < kParts; ++part) {
      Part linear[3];
      for (int i = 0; i < 3; ++i) linear[i] = partOf(solved.first == 0 ? v[i] : U[begin + 3 * i], part);
      for (int j = 0; j < count; ++j) {
        const std::size_t k = begin + 3 * static_cast<std::size_t>(solved.first + j);
        Part u{};
        if (solved.first > 0) u -= partOf(v[j], part);
        for (int i = 0; i < 3; ++i) u += linear[i] * partOf(solved.mix[3 * j + i], part);
        partOf(U[k], part) = u;
        reinterpret_cast<FloatPart*>(&V[k])[part] = __builtin_convertvector(u * solved.unit, FloatPart);
      }
    }
    v += count;
  }
}

PALPATE_MULTIVERSION
void sumFields(const KernelInput& input, int nodes, const Lanes* monomials, Lanes* u) {
  for (int part = 0; part < kParts; ++part)
    for (int node = 0; node < nodes; ++node) {
      const Lanes* from = input.U + static_cast<std::ptrdiff_t>(node) * input.coefficients * 3;
      Part sum[3] = {};
      for (int k = 0; k < input.coefficients; ++k)
        for (int c = 0; c < 3; ++c) sum[c] += partOf(monomials[k], part) * partOf(from[3 * k + c], part);
      for (int c = 0; c < 3; ++c) partOf(u[3 * node + c], part) = sum[c];
    }
}

PALPATE_MULTIVERSION
void leastDetF(const KernelInput& summed, Lanes* least) {
  withPoints(
      summed, [&](const auto& typed)
                  __attribute__((always_inline)) { point_kernel::leastDetAll(typed, *least); });
}

PALPATE_MULTIVERSION
void gradientBounds(const KernelInput& input, const FloatLanes* powers, FloatLanes* bounds) {
  withPoints(
      input, [&](const auto& typed) __attribute__((always_inline)) {
        for (int n = 0; n < typed.point_count; ++n) point_kernel::boundPoint(typed, n, powers, bounds[n]);
      });
}

}  // namespace palpate::solver
