// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/cauchy_product.h"

#include <algorithm>

namespace palpate::solver {

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

}  // namespace palpate::solver
