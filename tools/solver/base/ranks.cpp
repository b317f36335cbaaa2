// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/base/ranks.h"

namespace palpate::solver {

void Ranks::broadcast(std::span<std::byte> /*data*/, int /*from*/) const {}
void Ranks::move(std::span<std::byte> /*data*/, int /*from*/, int /*to*/) const {}

bool Ranks::all(bool own) const {
  bool all = true;
  for (int from = 0; from < size(); ++from) {
    std::byte said{own};
    broadcast({&said, 1}, from);
    all = all && said != std::byte{0};
  }
  return all;
}

const Ranks& Ranks::one() {
  static const Ranks ranks;
  return ranks;
}

}  // namespace palpate::solver
