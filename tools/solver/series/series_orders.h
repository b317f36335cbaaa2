// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/base/multi_index.h"

namespace palpate::solver {

/// No domain radius is larger, m: nor is a travel that asks for one.
inline constexpr double kLargestRadius = 0.05;

/// Degrees of a series: of the fields, p, and of the answer (the force, where d is prescribed).
struct SeriesOrders {
  int fields;
  int answer;

  /// The answer to 2p, to which fields of degree p make it right (docs/design.md, Series), up to 6.
  [[nodiscard]] static constexpr SeriesOrders of(int fields) noexcept {
    return {fields, std::max(fields, std::min(2 * fields, 6))};
  }
  /// Degrees of an answer from which radii can be judged: a linear one leaves no remainder to judge by.
  [[nodiscard]] constexpr int leastAnswer() const noexcept { return std::max(2, fields); }
  [[nodiscard]] constexpr int mostAnswer() const noexcept { return std::min(2 * fields, kMostForceOrder); }
  [[nodiscard]] constexpr bool areValid() const noexcept {
    return fields >= 1 && fields <= kMostOrder && answer >= fields && answer <= mostAnswer();
  }
  /// @throw std::invalid_argument unless they are valid
  [[nodiscard]] const SeriesOrders& checked() const {
    if (!areValid())
      throw std::invalid_argument("a series with fields of degree " + std::to_string(fields) +
                                  " and an answer of degree " + std::to_string(answer));
    return *this;
  }
};

}  // namespace palpate::solver
