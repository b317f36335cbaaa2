// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "core/base/multi_index.h"

namespace palpate::solver {

/// Degrees of a series: of the fields, p, and of the answer (the force, where d is prescribed).
struct SeriesOrders {
  static constexpr int kMostFields = 7, kMostAnswer = MonomialBasis::kMaxOrder - 1;

  int fields;
  int answer;

  /// The answer to 2p, to which fields of degree p make it right (docs/design.md, Series), up to 6.
  [[nodiscard]] static constexpr SeriesOrders of(int fields) noexcept {
    return {fields, std::max(fields, std::min(2 * fields, 6))};
  }
  [[nodiscard]] constexpr bool areKnown() const noexcept {
    return fields >= 1 && fields <= kMostFields && answer >= fields &&
           answer <= std::min(2 * fields, kMostAnswer);
  }
};

}  // namespace palpate::solver
