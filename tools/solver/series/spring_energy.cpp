// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/series/spring_energy.h"

#include <cmath>
#include <cstddef>

namespace palpate::solver {

void addSpringEnergies(const FeModel& model, const NodeOrder& order, const MonomialBasis& basis,
                       const KernelInput& input, const CauchyRows& rows, Lanes* W) {
  const int count = basis.size();
  LaneVector scaled(static_cast<std::size_t>(3 * count));  // U_k length^|alpha_k|
  for (const auto& [node, stiffness] : model.springs()) {
    const Lanes* U = input.U + order.placeOf(node) * static_cast<std::size_t>(3 * input.coefficients);
    for (int k = 0; k < count; ++k) {
      const double unit = std::pow(input.length, basis[k][0] + basis[k][1] + basis[k][2]);
      for (int c = 0; c < 3; ++c) scaled[static_cast<std::size_t>(3 * k + c)] = unit * U[3 * k + c];
    }
    const auto at = [&](int k) { return scaled.data() + static_cast<std::ptrdiff_t>(3 * k); };
    for (int b = 0; b < count && b + 1 < static_cast<int>(rows.begin.size()); ++b)
      for (int p = rows.begin[static_cast<std::size_t>(b)]; p < rows.begin[static_cast<std::size_t>(b) + 1];
           ++p) {
        const auto [c, k] = rows.entries[static_cast<std::size_t>(p)];
        if (c >= count) continue;
        const Lanes product = at(b)[0] * at(c)[0] + at(b)[1] * at(c)[1] + at(b)[2] * at(c)[2];
        W[k] += (b == c ? 0.5 : 1.0) * stiffness * product;
      }
  }
}

}  // namespace palpate::solver
