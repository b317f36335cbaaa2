// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::bench {

/// Prints, size by size, how long a whole step() with near field takes on a synthetic model with so many
/// modes, beginning at 20,000 surface nodes, and the largest that was found to fit: p99 below a millisecond,
/// the period at 1 kHz. Larger ones are tried up to 100,000 nodes, smaller ones down to 500. @return whether
/// any fitted
bool printScale(int modes);

}  // namespace palpate::bench
