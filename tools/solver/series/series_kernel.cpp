// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/series/series_kernel.h"

namespace palpate::solver {

PALPATE_MULTIVERSION
void assembleDegree(const KernelInput& input, const CauchyProduct& product, int first, int last, Lanes* r) {
  point_kernel::assembleAll(input, product, first, last, r);
}

PALPATE_MULTIVERSION
void energyCoefficients(const KernelInput& input, const CauchyProduct& strain, const CauchyProduct& energy,
                        int first, int last, Lanes* W) {
  point_kernel::energyAll(input, strain, energy, first, last, W);
}

PALPATE_MULTIVERSION
void detF(const KernelInput& input, int point, const Lanes* monomials, Lanes* det) {
  for (int part = 0; part < kParts; ++part) point_kernel::detPart(input, point, part, monomials, det);
}

PALPATE_MULTIVERSION
void gradientBounds(const KernelInput& input, const Lanes* powers, Lanes* bounds) {
  for (int n = 0; n < input.point_count; ++n)
    for (int part = 0; part < kParts; ++part) point_kernel::boundPart(input, n, part, powers, bounds);
}

}  // namespace palpate::solver
