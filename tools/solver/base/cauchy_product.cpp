// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/cauchy_product.h"

#include <cstddef>

namespace palpate::solver {

CauchyProduct::CauchyProduct(const MonomialBasis& basis, int factor_order) {
  begin.push_back(0);
  for (int k = 0; k < basis.size(); ++k) {
    degree.push_back(basis[k][0] + basis[k][1] + basis[k][2]);
    factors.push_back(begin.back());
    for (int b = 0; b < k; ++b) {
      const int c =
          basis.find({basis[k][0] - basis[b][0], basis[k][1] - basis[b][1], basis[k][2] - basis[b][2]});
      if (c < b) continue;
      pairs.push_back({b, c});
      if (c >= MonomialBasis::size(factor_order)) factors.back() = static_cast<int>(pairs.size());
    }
    begin.push_back(static_cast<int>(pairs.size()));
  }
}

CauchyRows::CauchyRows(const CauchyProduct& product, int first) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  std::vector<std::vector<Entry>> rows;
  for (int k = first; at(k) + 1 < product.begin.size(); ++k)
    for (int p = product.begin[at(k)]; p < product.begin[at(k) + 1]; ++p) {
      const auto [b, c] = product.pairs[at(p)];
      if (rows.size() <= at(b)) rows.resize(at(b) + 1);
      rows[at(b)].push_back({c, k - first});
    }
  begin.push_back(0);
  for (const std::vector<Entry>& row : rows) {
    entries.insert(entries.end(), row.begin(), row.end());
    begin.push_back(static_cast<int>(entries.size()));
  }
}

}  // namespace palpate::solver
