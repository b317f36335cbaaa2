// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/ranks.h"

namespace palpate::solver {

void Ranks::broadcast(std::span<std::byte> /*data*/, int /*from*/) const {}
void Ranks::move(std::span<std::byte> /*data*/, int /*from*/, int /*to*/) const {}

const Ranks& Ranks::one() {
  static const Ranks ranks;
  return ranks;
}

}  // namespace palpate::solver
