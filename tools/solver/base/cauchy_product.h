// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/multi_index.h"

namespace palpate::solver {

/// The unordered pairs {b, c}, b + c = alpha, b <= c, that make up each coefficient of a basis. Those with factors above
/// factor_order come first.
struct CauchyProduct {
  struct Pair {
    int b;
    int c;
  };
  CauchyProduct(const MonomialBasis& basis, int factor_order);
  std::vector<Pair> pairs;
  std::vector<int> begin;    ///< coefficients + 1, offsets into pairs
  std::vector<int> factors;  ///< coefficients, offsets: from here on both are of degree factor_order at most
  std::vector<int> degree;   ///< coefficients, |alpha|
};

/// The pairs of a product from coefficient `first` on, by their first factor: a kernel that takes them in this
/// order reads b once.
struct CauchyRows {
  struct Entry {
    int c;
    int k;  ///< the coefficient that b and c make up, counted from `first`
  };
  CauchyRows(const CauchyProduct& product, int first);
  std::vector<Entry> entries;
  std::vector<int> begin;  ///< by b, and the end; offsets into entries
};

}  // namespace palpate::solver
